#!/usr/bin/env bash
# ros-jazzy-rclpy 7.1.6 (Fast DDS 2.14): most of a further node's memory is room for messages that
# nobody has sent.
#
# A good guess is that a second node in a process costs next to nothing until it sends something.
# It costs 1.2 MB: its two dozen publishers and subscriptions, those of its services included,
# reserve as many samples as their depth, up to 100 (resourceLimitsQos, allocated_samples). They
# could make that room when they need it: a default profile of writers and readers that reserves
# one sample is honoured, though rmw_fastrtps reads no QoS from profiles by default, and a node
# costs 0.5 MB. What is delivered stays the same.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q "ros-jazzy-rclpy[fastrtps]==7.1.6"
export ROS_LOG_DIR="$folder" ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST

"$folder/venv/bin/python" - "$folder" <<'PYTHON'
import os
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

END_POINT = """<data_{0} profile_name="{0}" is_default_profile="true"><topic><resourceLimitsQos>
  <allocated_samples>1</allocated_samples></resourceLimitsQos></topic></data_{0}>"""
NODES = """
import rclpy
from rclpy.node import Node
def private():
    line = next(l for l in open("/proc/self/smaps_rollup") if l.startswith("Private_Dirty"))
    return int(line.split()[1])
rclpy.init()
nodes = [Node("first")]
before = private()
nodes += [Node(f"n{number}") for number in range(8)]
print((private() - before) // 8)
for node in nodes:
    node.destroy_node()
rclpy.shutdown()
"""


def kilobytes(**environment):
    command = [sys.executable, "-W", "ignore", "-c", NODES]
    said = subprocess.check_output(command, env={**os.environ, **environment}, text=True)
    return int(said.splitlines()[-1])  # Fast DDS may speak of shared memory of others before.


file = Path(sys.argv[1], "one_sample.xml")
file.write_text(
    '<dds xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles"><profiles>'
    f"{END_POINT.format('writer')}{END_POINT.format('reader')}</profiles></dds>"
)
print("ros-jazzy-rclpy", version("ros-jazzy-rclpy"))
default, one = kilobytes(), kilobytes(FASTRTPS_DEFAULT_PROFILES_FILE=str(file))
print(f"a further node: {default} KB, with room for one sample at first {one} KB")
if not one < 0.6 * default:
    sys.exit("the behaviour has changed")
PYTHON
