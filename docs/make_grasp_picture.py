"""Makes the manual's picture of the grasp, with the depth camera on its stand."""

import os
import signal
import subprocess
import sys
from pathlib import Path

os.environ.setdefault("AMENT_PREFIX_PATH", sys.prefix)
os.environ.setdefault("ROS_DOMAIN_ID", "62")
os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")

import cv2
import numpy as np
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import Image

PICTURE = Path(__file__).with_name("images") / "grasp.png"
LAUNCH = ("mycobot_gazebo", "pick_and_place.launch.py", "use_camera:=true", "hold_time:=600")
TOPIC = "/camera_head/color/image_raw"
HELD_UP = "Holding for"


def main() -> None:
    """Save one image while the cylinder is held up."""
    command = [sys.executable, "-m", "arm_cli", "launch", *LAUNCH]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as launcher:
        assert launcher.stdout is not None
        for line in launcher.stdout:
            sys.stdout.write(line)
            if HELD_UP in line:
                break
        image = take_picture()
        launcher.send_signal(signal.SIGINT)
        launcher.communicate(timeout=60)
    pixels = np.frombuffer(image.data, np.uint8).reshape(image.height, image.width, 3)
    cv2.imwrite(str(PICTURE), cv2.cvtColor(pixels, cv2.COLOR_RGB2BGR))


def take_picture() -> Image:
    """Return the camera's next picture."""
    rclpy.init()
    node = Node("make_grasp_picture")
    pictures: list[Image] = []
    node.create_subscription(Image, TOPIC, pictures.append, 10)
    while not pictures:
        rclpy.spin_once(node)
    node.destroy_node()
    rclpy.shutdown()
    return pictures[-1]


if __name__ == "__main__":
    main()
