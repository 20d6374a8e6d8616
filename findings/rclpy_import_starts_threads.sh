#!/usr/bin/env bash
# ros-jazzy-rclpy 7.1.6: `import rclpy` alone starts two threads.
#
# A good guess is that a process has one thread until rclpy.init(), so that a warm process can import
# rclpy once and fork a node from it. The wheels bring the tracer lttng-ust, whose library starts its
# two listeners when it is loaded, whether anybody traces or not. So every fork after the import is
# that of a process with several threads; nothing of Python's knows of them: threading.enumerate()
# still lists one.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q "ros-jazzy-rclpy[fastrtps]==7.1.6"

"$folder/venv/bin/python" - <<'PYTHON'
import os
import sys
import threading
from importlib.metadata import version


def threads():
    return len(os.listdir("/proc/self/task"))


before = threads()
import rclpy  # noqa: E402, F401

after = threads()
with open("/proc/self/maps", encoding="utf-8") as maps:
    tracer = any("liblttng-ust" in line for line in maps)
print("ros-jazzy-rclpy", version("ros-jazzy-rclpy"))
print("threads before and after `import rclpy`:", before, after)
print("threads that Python knows:", threading.active_count())
print("lttng-ust is loaded:", tracer)
if (before, after, threading.active_count(), tracer) != (1, 3, 1, True):
    sys.exit("the behaviour has changed")
PYTHON
