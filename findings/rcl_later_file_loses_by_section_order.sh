#!/usr/bin/env bash
# ros-jazzy-rclpy 7.1.6 (rcl's YAML parser 9.2.8): the last of three parameter files does not win.
#
# A good guess is that the last --params-file which gives a node a value wins, or else the section
# that names the node most exactly. rcl merges the sections of one name over all files, and applies
# them in the order in which their names FIRST appear. So with
#   first.yaml   /n:   gain: 1
#   second.yaml  /**:  gain: 2
#   third.yaml   /n:   gain: 3
# the section /n comes before /**, and the node gets 2: neither the last file nor the exact name
# counts. Without first.yaml it gets 3. A launch file with parameters=[{...}, "robot.yaml", {...}]
# is of this form: the last dict loses to the file.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q "ros-jazzy-rclpy[fastrtps]==7.1.6"
export ROS_LOG_DIR="$folder" ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST

"$folder/venv/bin/python" - "$folder" <<'PYTHON'
import sys
from importlib.metadata import version
from pathlib import Path

import rclpy
from rclpy.node import Node

folder = Path(sys.argv[1])
rclpy.init(args=[])


def gain(*sections):
    words = []
    for number, (name, value) in enumerate(sections):
        path = folder / f"{number}.yaml"
        path.write_text(f"{name}:\n  ros__parameters:\n    gain: {value}\n")
        words += ["--params-file", str(path)]
    node = Node("n", cli_args=["--ros-args", *words], use_global_arguments=False)
    value = node.declare_parameter("gain", 0).value
    node.destroy_node()
    return value


print("ros-jazzy-rclpy", version("ros-jazzy-rclpy"))
three = gain(("/n", 1), ("/**", 2), ("/n", 3))
two = gain(("/**", 2), ("/n", 3))
exact_first = gain(("/n", 1), ("/**", 2))
print("/n: 1, then /**: 2, then /n: 3 ->", three)
print("/**: 2, then /n: 3             ->", two)
print("/n: 1, then /**: 2             ->", exact_first)
rclpy.shutdown()
if (three, two, exact_first) != (2, 3, 2):
    sys.exit("the behaviour has changed")
PYTHON
