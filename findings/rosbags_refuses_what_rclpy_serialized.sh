#!/usr/bin/env bash
# rosbags 0.11.9 cannot read a joint state without velocities that ros-jazzy-rclpy 7.1.6 serialised.
#
# A good guess is that serialize_message() returns a message's CDR, which any reader of CDR takes: a
# Bool is a header of four bytes and one more. rclpy returns eight bytes for it, and up to eight more
# than the fields take for messages that end in empty lists of float64. rosbags lets three more bytes
# pass and refuses the rest with "CDR message size mismatch". A JointState that has positions alone is
# such a message, and so is a Float64MultiArray without data: a bag that a program writes with
# serialize_message() has them in it. deserialize_message() skips the rest.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'ros-jazzy-rclpy[fastrtps]==7.1.6' \
  'ros-jazzy-common-interfaces==5.3.6' 'rosbags==0.11.9'

"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

from rclpy.serialization import deserialize_message, serialize_message
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_typestore
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Float64MultiArray

print("ros-jazzy-rclpy", version("ros-jazzy-rclpy"), "rosbags", version("rosbags"))
store = get_typestore(Stores.ROS2_JAZZY)
seen = []
for kind, message in (
    ("std_msgs/msg/Bool", Bool()),
    ("std_msgs/msg/Float64MultiArray", Float64MultiArray(data=[1.0])),
    ("std_msgs/msg/Float64MultiArray", Float64MultiArray()),
    ("sensor_msgs/msg/JointState", JointState(name=["a"], position=[1.0], velocity=[0.0], effort=[0.0])),
    ("sensor_msgs/msg/JointState", JointState(name=["a"], position=[1.0])),
):
    written = serialize_message(message)
    if deserialize_message(written, type(message)) != message:
        sys.exit("rclpy does not read its own message")
    try:
        read = store.deserialize_cdr(written, kind)
        said = f"{len(store.serialize_cdr(read, kind))} of its own"
    except SerdeError as error:
        said = str(error)
    print(f"{kind}: {len(written)} bytes, rosbags: {said}")
    seen.append((len(written), said.partition(" for ")[0]))
refused = "CDR message size mismatch"
if seen != [(8, "5 of its own"), (24 + 4, "28 of its own"), (20, refused), (76, "76 of its own"), (60, refused)]:
    sys.exit(f"the behaviour has changed: {seen}")
PYTHON
