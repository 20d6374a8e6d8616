#!/usr/bin/env bash
# ros-jazzy-rclpy 7.1.6 (rosidl_generator_py 0.22.2): a node imports the generator of its messages.
#
# A good guess is that a node of installed messages needs their classes alone: what generates such
# classes from .idl files is a tool of the build. But each class takes its C code by `from
# rosidl_generator_py import import_type_support`, and that package's __init__.py also imports
# generate_py, and with it the parser of .idl files (lark and its grammar) and the templates (em).
# So every process with a node, `ros2 topic list` as well, has some 30 modules of them: about 4 MB
# and 60 ms. Where they are not installed, the package goes on without them: nobody misses them.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q "ros-jazzy-rclpy[fastrtps]==7.1.6"
export ROS_LOG_DIR="$folder" ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST

"$folder/venv/bin/python" - <<'PYTHON'
import subprocess
import sys
from importlib.metadata import version

NODE = """
import sys
for name in {missing}:
    sys.modules[name] = None  # As if it were not installed.
import rclpy
from rclpy.node import Node
rclpy.init()
node = Node("n")
tools = ("lark", "em", "rosidl_parser.parser", "rosidl_generator_py.generate_py_impl")
private = next(l for l in open("/proc/self/smaps_rollup") if l.startswith("Private_Dirty"))
print(sum(sys.modules.get(name) is not None for name in tools), int(private.split()[1]))
node.destroy_node()
rclpy.shutdown()
"""


def run(*missing):
    command = [sys.executable, "-W", "ignore", "-c", NODE.format(missing=list(missing))]
    # Fast DDS may say something about shared memory of others before.
    last = subprocess.check_output(command, text=True).splitlines()[-1]
    return map(int, last.split())


print("ros-jazzy-rclpy", version("ros-jazzy-rclpy"))
tools, kilobytes = run()
none, without = run("rosidl_generator_py.generate_py_impl")
print(f"a node: {tools} of the 4 modules of the generator, {kilobytes} KB of its own")
print(f"without the generator it runs as well: {none} of them, {kilobytes - without} KB less")
if (tools, none) != (4, 0) or kilobytes - without < 2000:
    sys.exit("the behaviour has changed")
PYTHON
