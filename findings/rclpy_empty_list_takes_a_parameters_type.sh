#!/usr/bin/env bash
# ros-jazzy-rclpy 7.1.6: `-p NAME:=[]` is accepted for a parameter of any type, and its value is None.
#
# A good guess is that a statically typed parameter either takes its default or refuses what does not
# fit its type, as it refuses `-p rate:=word` for a double. An empty list on the command line or in a
# parameter file is neither refused nor an empty list: declare_parameter("rate", 2.0) returns a
# parameter of the type NOT_SET with the value None, while describe_parameter still says DOUBLE. So a
# program that multiplies its rate ends with a TypeError, and one that asks for a list of names has to
# expect None.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'ros-jazzy-rclpy[fastrtps]==7.1.6'
export ROS_LOG_DIR=$folder ROS_AUTOMATIC_DISCOVERY_RANGE=OFF

"$folder/venv/bin/python" - --ros-args -p 'rate:=[]' -p 'names:=[]' -p 'title:=[]' <<'PYTHON'
import sys
from importlib.metadata import version

import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter

rclpy.init(args=sys.argv)
node = Node("empty_lists")
print("ros-jazzy-rclpy", version("ros-jazzy-rclpy"))
seen = []
for name, default in (("rate", 2.0), ("names", ["a"]), ("title", "none")):
    parameter = node.declare_parameter(name, default)
    described = Parameter.Type(node.describe_parameter(name).type).name
    print(f"{name}: default {default!r}, value {parameter.value!r}, described as {described}")
    seen.append((parameter.value, described))
node.destroy_node()
rclpy.shutdown()
if seen != [(None, "DOUBLE"), (None, "STRING_ARRAY"), (None, "STRING")]:
    sys.exit("the behaviour has changed")
PYTHON
