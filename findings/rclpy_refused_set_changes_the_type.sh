#!/usr/bin/env bash
# ros-jazzy-rclpy 7.1.6: a refused value changes the type that a parameter is described with.
#
# A parameter with dynamic_typing takes values of any type, and a callback that
# add_on_set_parameters_callback registers decides which. A good guess is that a value that the
# callback refuses changes nothing. The value does stay, but rclpy writes the refused value's type
# into the stored descriptor before it asks the callback: `ros2 param describe` says "string" of a
# parameter whose value is a double, until the next accepted set. get_parameter_types, which looks at
# the value, disagrees. Tools that offer a field by the described type offer the wrong one. Without
# dynamic_typing the type stays.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'ros-jazzy-rclpy[fastrtps]==7.1.6'
export ROS_LOG_DIR=$folder ROS_AUTOMATIC_DISCOVERY_RANGE=OFF

"$folder/venv/bin/python" - <<'PYTHON'
from importlib.metadata import version

import rclpy
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter


def accept_numbers(changed):
    fits = all(isinstance(parameter.value, float) for parameter in changed)
    return SetParametersResult(successful=fits, reason="" if fits else "it must be a number")


rclpy.init()
node = Node("gains")
node.declare_parameter("gain", 2.5, ParameterDescriptor(dynamic_typing=True))
node.add_on_set_parameters_callback(accept_numbers)
names = {kind.value: kind.name for kind in Parameter.Type}


def described():
    return names[node.describe_parameter("gain").type]


before = described()
(result,) = node.set_parameters([Parameter("gain", value="high")])
after, value = described(), node.get_parameter("gain").value
kept = names[node.get_parameter_type("gain")]
print(f"ros-jazzy-rclpy {version('ros-jazzy-rclpy')}")
print(f"set 'high': successful={result.successful}, value is still {value!r}")
print(f"described as {before} before, as {after} after; the value's own type is {kept}")
node.destroy_node()
rclpy.shutdown()
assert (result.successful, value, before, kept) == (False, 2.5, "DOUBLE", "DOUBLE")
assert after == "STRING", "the behaviour has changed"
PYTHON
