#!/usr/bin/env bash
# ros-jazzy-rclpy 7.1.6: a node that only publishes strings imports NumPy.
#
# A good guess is that NumPy comes with messages that have arrays of a fixed length, such as
# CameraInfo. After `import rclpy` and std_msgs' String it is indeed not there. Creating a node
# imports it: each service, those of the parameters among them, has an event message since Jazzy,
# and service_msgs' ServiceEventInfo has an array of 16 bytes for the client's identity. Nobody sends
# that event unless introspection is switched on, but NumPy stays: 10 MB or more of the process.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q "ros-jazzy-rclpy[fastrtps]==7.1.6" ros-jazzy-common-interfaces==5.3.6
export ROS_LOG_DIR="$folder" ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST

"$folder/venv/bin/python" - <<'PYTHON'
import re
import sys
from importlib.metadata import version

import rclpy
from std_msgs.msg import String


def state():
    with open("/proc/self/smaps_rollup", encoding="utf-8") as file:
        text = file.read()
    private_mb = sum(map(int, re.findall(r"^Private_\w+:\s+(\d+)", text, re.M))) / 1024
    return "numpy" in sys.modules, "service_msgs.msg._service_event_info" in sys.modules, private_mb


rclpy.init(args=[])
before = state()
node = rclpy.create_node("strings")
node.create_publisher(String, "text", 1)
after = state()
print("ros-jazzy-rclpy", version("ros-jazzy-rclpy"))
print("before the node: NumPy, ServiceEventInfo, private MB:", *before)
print("with the node:   NumPy, ServiceEventInfo, private MB:", *after)
node.destroy_node()
rclpy.shutdown()
if before[:2] != (False, False) or after[:2] != (True, True):
    sys.exit("the behaviour has changed")
PYTHON
