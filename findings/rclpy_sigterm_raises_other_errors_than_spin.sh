#!/usr/bin/env bash
# ros-jazzy-rclpy 7.1.6: outside of spin, SIGTERM shows as NotInitializedException or RCLError.
#
# The usual way to end a node is `except (KeyboardInterrupt, ExternalShutdownException)` around the
# making of the node and `rclpy.spin(node)`. A good guess is that it covers SIGTERM, wherever the
# program is. The handler that rclpy.init() installs only shuts the context down; the next call that
# needs it raises, and only an executor that spins makes that an ExternalShutdownException. Node() says
# that rclpy.init() has not been called; create_publisher() and others raise RCLError, a RuntimeError.
# So a node that is stopped while it is made ends with a traceback and exit code 1. A program has to
# ask rclpy.ok() in the handler of any other exception.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'ros-jazzy-rclpy[fastrtps]==7.1.6' 'ros-jazzy-common-interfaces==5.3.6'
export ROS_LOG_DIR=$folder ROS_AUTOMATIC_DISCOVERY_RANGE=OFF

"$folder/venv/bin/python" - <<'PYTHON'
import os
import signal
import sys
import time
from importlib.metadata import version

import rclpy
from rclpy.node import Node
from std_msgs.msg import String


def raised(call):
    try:
        call()
    except Exception as error:
        return type(error).__name__
    return "nothing"


rclpy.init()
node = Node("first")
os.kill(os.getpid(), signal.SIGTERM)
while rclpy.ok():  # The context is shut down in another thread.
    time.sleep(0.01)
seen = {
    "Node": raised(lambda: Node("second")),
    "create_publisher": raised(lambda: node.create_publisher(String, "topic", 1)),
    "get_topic_names_and_types": raised(node.get_topic_names_and_types),
}
print("ros-jazzy-rclpy", version("ros-jazzy-rclpy"))
for name, error in seen.items():
    print(f"{name} raises {error}")
wanted = ["NotInitializedException", "RCLError", "RCLError"]
if list(seen.values()) != wanted:
    sys.exit("the behaviour has changed")
PYTHON
