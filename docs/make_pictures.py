"""Makes the manual's pictures: two robots, and what the arm's front camera publishes.

    python docs/make_pictures.py

The robots are drawn from the models that are simulated; the last picture is taken off /videocamera
of a running `arm launch`, with the gripper lowered into the view.
"""

import os
import signal
import subprocess
import sys
from pathlib import Path

os.environ.setdefault("MUJOCO_GL", "egl")
os.environ.setdefault("AMENT_PREFIX_PATH", sys.prefix)
os.environ.setdefault("ROS_DOMAIN_ID", "61")

import cv2
import mujoco
import numpy as np
import rclpy
from ament_index_python.packages import get_package_share_directory
from rclpy.node import Node
from sensor_msgs.msg import Image, JointState
from std_msgs.msg import Float64MultiArray

from arm_control.hardware.info import parse_hardware_info
from arm_description.urdf.parser import parse_urdf
from arm_description.xacro.expansion import expand_xacro
from arm_gazebo.model.builder import build_model
from arm_gazebo.robot.part import Base, BuildOptions

IMAGES = Path(__file__).with_name("images")
WIDTH, HEIGHT = 960, 720
REACHING = {"j0_pos": "0.4", "j1_pos": "0.5", "j2_pos": "0.5", "j3_pos": "1.0"}
INTO_THE_VIEW = [0.0, 1.0, 0.6, 0.6]


def draw_arm(path: Path) -> None:
    """Draw the arm, reaching forward, in the empty world."""
    arm = get_package_share_directory("arm_description") + "/urdf/arm.urdf.xacro"
    draw(expand_xacro(arm, {**REACHING, "camera": "front"}), path, (0.04, -0.07, 0.15), 0.62)


def draw_rosmaster(path: Path) -> None:
    """Draw the ROSMASTER X3, standing on its wheels."""
    share = get_package_share_directory("yahboom_rosmaster_description")
    text = expand_xacro(f"{share}/urdf/robots/rosmaster_x3.urdf.xacro", {"use_gazebo": "true"})
    draw(text, path, (-0.02, 0.0, 0.1), 0.65, base="free")


def draw(
    text: str,
    path: Path,
    look_at: tuple[float, float, float],
    distance: float,
    base: Base = "fixed",
) -> None:
    """Draw a robot in the empty world, from the front and its left.

    Args:
        text: its URDF.
        path: of the picture.
        look_at: the middle of the picture, in m.
        distance: from there, in m.
        base: as of sim.launch.py.
    """
    built = build_model(
        parse_urdf(text), parse_hardware_info(text), options=BuildOptions(base=base)
    )
    model, data = built.model, mujoco.MjData(built.model)
    model.vis.global_.offwidth, model.vis.global_.offheight = WIDTH * 2, HEIGHT * 2
    # The cameras render without shadows, which cost most of a software frame; a picture has time.
    model.vis.quality.shadowsize = 8192
    model.vis.headlight.diffuse[:] = 0.5
    data.qpos[:] = built.qpos
    mujoco.mj_forward(model, data)
    view = mujoco.MjvCamera()
    view.lookat[:] = look_at
    view.distance, view.azimuth, view.elevation = distance, 215.0, -16.0
    with mujoco.Renderer(model, HEIGHT * 2, WIDTH * 2) as renderer:
        renderer.update_scene(data, view)
        picture = renderer.render()
    picture = cv2.resize(picture, (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA)
    cv2.imwrite(str(path), cv2.cvtColor(picture, cv2.COLOR_RGB2BGR))


def take_camera_picture(path: Path) -> None:
    """Save an image of /videocamera once the gripper is in view."""
    launcher = subprocess.Popen([sys.executable, "-m", "arm_cli", "launch", "world:=objects"])
    rclpy.init()
    node = Node("make_pictures")
    states: list[JointState] = []
    images: list[Image] = []
    node.create_subscription(JointState, "/joint_states", states.append, 10)
    node.create_subscription(Image, "/videocamera", images.append, 10)
    commands = node.create_publisher(Float64MultiArray, "/position_controller/commands", 10)
    command = Float64MultiArray(data=INTO_THE_VIEW)
    node.create_timer(0.5, lambda: commands.publish(command))

    while not (states and np.allclose(states[-1].position, INTO_THE_VIEW, atol=0.01)):
        rclpy.spin_once(node)
    images.clear()
    while not images:
        rclpy.spin_once(node)
    image = images[-1]
    pixels = np.frombuffer(image.data, np.uint8).reshape(image.height, image.width, 3)
    cv2.imwrite(str(path), cv2.cvtColor(pixels, cv2.COLOR_RGB2BGR))
    node.destroy_node()
    rclpy.shutdown()
    launcher.send_signal(signal.SIGINT)
    launcher.wait(30)


def main() -> None:
    """Make the pictures."""
    IMAGES.mkdir(exist_ok=True)
    draw_arm(IMAGES / "arm.png")
    draw_rosmaster(IMAGES / "rosmaster_x3.png")
    take_camera_picture(IMAGES / "camera.png")


if __name__ == "__main__":
    main()
