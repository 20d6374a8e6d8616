"""Makes a node, removes its ports the first TIMES times, and listens for at most SECONDS.

Run it as `python lose_ports.py TIMES SECONDS`. It prints how many nodes were made, whether the last
one's ports are lost, and whether a message of another process arrived.
"""

import os
import subprocess
import sys
import time

import rclpy
from std_msgs.msg import String

from arm_node.workarounds.discovery import first_node
from arm_node.workarounds.lost_ports import lost_ports
from arm_node.workarounds.used_files import read_ports

SPEAK = """
import os, sys, time
import rclpy
from std_msgs.msg import String
rclpy.init()
publisher = rclpy.create_node("speaker").create_publisher(String, "said", 1)
while os.getppid() == int(sys.argv[1]):
    publisher.publish(String(data="hello"))
    time.sleep(0.05)
"""


def main(times: int, listen_s: float) -> None:
    """Make the node and listen."""
    made = []

    def make():
        made.append(rclpy.create_node("listener"))
        if len(made) <= times:
            for port in read_ports():
                os.unlink(port)
        return made[-1]

    rclpy.init()
    node = first_node(make)
    print(f"made {len(made)}, lost {bool(lost_ports())}")
    heard = []
    node.create_subscription(String, "said", heard.append, 1)
    with subprocess.Popen([sys.executable, "-c", SPEAK, str(os.getpid())]) as speaker:
        try:
            end_s = time.monotonic() + listen_s
            while not heard and time.monotonic() < end_s:
                rclpy.spin_once(node, timeout_sec=0.1)
        finally:
            speaker.kill()
    print(f"heard {bool(heard)}")
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main(int(sys.argv[1]), float(sys.argv[2]))
