#!/usr/bin/env bash
# ros-jazzy-rclpy 7.1.6: get_service_names_and_types() lists services that only have clients.
#
# A good guess is that the list has what one can call: a service appears with its server and goes with
# it. The graph makes the list from the topics of requests and responses, which clients have as well.
# So a program that waits for a service to vanish waits for its own client, and a name that was misspelt
# by anybody is listed. get_service_names_and_types_by_node() lists servers alone, and count_services()
# counts them.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'ros-jazzy-rclpy[fastrtps]==7.1.6' 'ros-jazzy-common-interfaces==5.3.6'
export ROS_LOG_DIR=$folder ROS_AUTOMATIC_DISCOVERY_RANGE=OFF

"$folder/venv/bin/python" - <<'PYTHON'
import sys
import time
from importlib.metadata import version

import rclpy
from std_srvs.srv import Trigger

rclpy.init()
node = rclpy.create_node("caller", start_parameter_services=False)
client = node.create_client(Trigger, "/nobody_serves_this")
deadline = time.monotonic() + 10.0
listed = False
while not listed and time.monotonic() < deadline:
    listed = "/nobody_serves_this" in dict(node.get_service_names_and_types())
    time.sleep(0.05)
served = node.count_services("/nobody_serves_this")
of_node = dict(node.get_service_names_and_types_by_node("caller", "/"))
ready = client.service_is_ready()
rclpy.shutdown()
print("ros-jazzy-rclpy", version("ros-jazzy-rclpy"))
print(f"listed: {listed}; servers: {served}; ready: {ready}; of its node: {'/nobody_serves_this' in of_node}")
if (listed, served, ready, "/nobody_serves_this" in of_node) != (True, 0, False, False):
    sys.exit("the behaviour has changed")
PYTHON
