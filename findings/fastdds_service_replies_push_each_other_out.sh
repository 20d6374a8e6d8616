#!/usr/bin/env bash
# ros-jazzy-rclpy 7.1.6 with Fast DDS: a client loses its answer to ten answers for other clients.
#
# A good guess is that each client receives its own answers, so that the ten that a client keeps by
# default are ten of its own. All clients of a service read one topic: every reader keeps the last
# ten answers to anybody, and looks for its own among them afterwards. Of 30 clients in a process
# that ask at once, once each, only some get an answer; the other futures are never done, without a
# warning, though the server, which keeps 1000 requests here, answered all. A client with a deeper
# history loses none: create_client(..., qos_profile=QoSProfile(depth=1000)).
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q "ros-jazzy-rclpy[fastrtps]==7.1.6" "ros-jazzy-test-msgs==2.0.3"
export ROS_LOG_DIR="$folder" ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID=88

"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import subprocess
import sys
import time
from importlib.metadata import version

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile
from test_msgs.srv import Empty

SERVER = """
import rclpy
from rclpy.qos import QoSProfile
from test_msgs.srv import Empty
rclpy.init()
node = rclpy.create_node("server")
qos = QoSProfile(depth=1000)
node.create_service(Empty, "empty", lambda request, response: response, qos_profile=qos)
rclpy.spin(node)
"""
CLIENTS = 30


def unanswered(depth):
    node = rclpy.create_node(f"clients_{depth}")
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    qos = QoSProfile(depth=depth)
    clients = [node.create_client(Empty, "empty", qos_profile=qos) for _ in range(CLIENTS)]
    for client in clients:
        client.wait_for_service()
    time.sleep(2.0)
    futures = [client.call_async(Empty.Request()) for client in clients]
    # The answers arrive while the program does something else.
    time.sleep(1.0)
    deadline = time.monotonic() + 5.0
    while not all(future.done() for future in futures) and time.monotonic() < deadline:
        executor.spin_once(timeout_sec=0.1)
    node.destroy_node()
    return sum(not future.done() for future in futures)


server = subprocess.Popen([sys.executable, "-W", "ignore", "-c", SERVER])
rclpy.init()
lost, deep = unanswered(10), unanswered(1000)
server.kill()
print("ros-jazzy-rclpy", version("ros-jazzy-rclpy"))
print(f"unanswered of {CLIENTS} at once: {lost} with a depth of 10, {deep} with 1000")
if lost < 10 or deep:
    sys.exit("the behaviour has changed")
PYTHON
