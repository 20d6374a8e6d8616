#!/usr/bin/env bash
# ros-jazzy-rclpy 7.1.6: an action client that another thread spins loses answers to its goals, a
# service client none.
#
# A good guess is that both are as safe: `call_async` and `send_goal_async` return a future, and many
# programs send from the main thread while an executor's thread spins. A service client holds a lock
# while it sends a request and notes its number. An action client has no lock there: an answer that
# the executor reads between the two is taken for someone else's ("Ignoring unexpected goal
# response") and thrown away, and the future is never done. The server has accepted the goal and
# carries it out. On a busy machine it happens with Python's usual switch interval, too.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q "ros-jazzy-rclpy[fastrtps]==7.1.6" "ros-jazzy-test-msgs==2.0.3"
export ROS_LOG_DIR="$folder" ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID=88

"$folder/venv/bin/python" -W ignore - 2>"$folder/warnings" <<'PYTHON'
import subprocess
import sys
import threading
import time
from importlib.metadata import version

import rclpy
from rclpy.action import ActionClient
from rclpy.executors import SingleThreadedExecutor
from test_msgs.action import Fibonacci
from test_msgs.srv import Empty

SERVER = """
import rclpy
from rclpy.action import ActionServer
from test_msgs.action import Fibonacci
from test_msgs.srv import Empty
def execute(goal):
    goal.succeed()
    return Fibonacci.Result()
rclpy.init()
node = rclpy.create_node("server")
node.create_service(Empty, "empty", lambda request, response: response)
server = ActionServer(node, Fibonacci, "count", execute)
rclpy.spin(node)
"""
REQUESTS = 2000

server = subprocess.Popen([sys.executable, "-W", "ignore", "-c", SERVER])
rclpy.init()
node = rclpy.create_node("client")
action = ActionClient(node, Fibonacci, "count")
service = node.create_client(Empty, "empty")
executor = SingleThreadedExecutor()
executor.add_node(node)
threading.Thread(target=executor.spin, daemon=True).start()
action.wait_for_server()
service.wait_for_service()
time.sleep(2.0)
sys.setswitchinterval(1e-6)


def unanswered(send):
    count = 0
    for _ in range(REQUESTS):
        future = send()
        deadline = time.monotonic() + 0.5
        while not future.done() and time.monotonic() < deadline:
            time.sleep(0.0005)
        count += not future.done()
    return count


goals = unanswered(lambda: action.send_goal_async(Fibonacci.Goal(order=1)))
calls = unanswered(lambda: service.call_async(Empty.Request()))
server.kill()
print("ros-jazzy-rclpy", version("ros-jazzy-rclpy"))
print(f"unanswered after 0.5 s: {goals} of {REQUESTS} goals, {calls} of {REQUESTS} calls")
if not goals or calls > goals // 4:
    sys.exit("the behaviour has changed")
PYTHON
thrown_away=$(grep -c "unexpected goal response" "$folder/warnings" || true)
echo "thrown away, by its warnings: $thrown_away"
[ "$thrown_away" -gt 0 ] || { echo "the behaviour has changed"; exit 1; }
