#!/usr/bin/env bash
# ros-jazzy-rclpy 7.1.6 (Fast DDS 2.14): a publisher whose subscriber was killed makes four files in
# /dev/shm, and removes them, for each message that it publishes.
#
# A good guess is that messages to a process that is gone go nowhere: its shared-memory port is
# there or it is not. Until the publisher gives the reader up (2 to 13 s were seen; its lease is
# 20 s), every `publish` creates the port's memory, its mutex and its two lock files anew, finds that
# nobody reads it, and removes all four. ros-kilted-rclpy 9.1.2 (Fast DDS 3.2) does the same.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q "ros-jazzy-rclpy[fastrtps]==7.1.6" \
  "ros-jazzy-common-interfaces==5.3.6" "inotify_simple==2.0.1"
export ROS_LOG_DIR="$folder" ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID=87

"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import re
import subprocess
import sys
import time
from collections import Counter
from importlib.metadata import version

import rclpy
from inotify_simple import INotify, flags
from std_msgs.msg import String

SUBSCRIBER = """
import rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("subscriber")
node.create_subscription(String, "text", lambda _: print("heard", flush=True), 10)
rclpy.spin(node)
"""
MESSAGES = 200
PORTS = range(7400 + 250 * 87, 7400 + 250 * 88)
"""Of this ROS domain."""

rclpy.init()
node = rclpy.create_node("publisher")
publisher = node.create_publisher(String, "text", 10)
process = subprocess.Popen(
    [sys.executable, "-W", "ignore", "-c", SUBSCRIBER], stdout=subprocess.PIPE, text=True
)
while not publisher.get_subscription_count():
    time.sleep(0.1)
time.sleep(1.0)
publisher.publish(String(data="x"))
while "heard" not in process.stdout.readline():
    pass
process.kill()
process.wait()
time.sleep(0.5)

watch = INotify()
watch.add_watch("/dev/shm", flags.CREATE | flags.DELETE)
watch.read(timeout=0)
seen = Counter()
for _ in range(MESSAGES):
    publisher.publish(String(data="x"))
    time.sleep(0.02)
    for event in watch.read(timeout=0):
        port = re.search(r"_port(\d+)(_mutex|_sl|)$", event.name)
        if port and int(port[1]) in PORTS:
            what = "made" if event.mask & flags.CREATE else "removed"
            seen[f"{event.name}: {what}"] += 1
print("ros-jazzy-rclpy", version("ros-jazzy-rclpy"))
for line, times in sorted(seen.items()):
    print(f"{line} {times} times with {MESSAGES} messages")
if len(seen) < 6 or max(seen.values()) < MESSAGES // 4:
    sys.exit("the behaviour has changed")
PYTHON
