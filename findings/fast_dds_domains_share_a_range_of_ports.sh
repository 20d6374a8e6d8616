#!/usr/bin/env bash
# ros-jazzy-rclpy 7.1.6 (Fast DDS 2.14): participants of different ROS domains count their ports in
# shared memory in one range, from 7000 on.
#
# A good guess is that a domain has numbers of its own, as for UDP: 7400 + 250 * ROS_DOMAIN_ID. The
# port of discovery does; the port of data is the first free one from 7000 on, of all domains of the
# machine. So what a process leaves or breaks at such a port meets a process of another domain,
# which can be of another user's test: domains do not keep tests apart in /dev/shm.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q "ros-jazzy-rclpy[fastrtps]==7.1.6"
export ROS_LOG_DIR="$folder" ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST

"$folder/venv/bin/python" -W ignore - <<'PYTHON'
import os
import re
import subprocess
import sys
from importlib.metadata import version

NODE = """
import sys
import rclpy
rclpy.init(domain_id=int(sys.argv[1]))
node = rclpy.create_node("alone")
print("there", flush=True)
sys.stdin.read()
"""
DOMAINS = 87, 93


def start(domain):
    words = [sys.executable, "-W", "ignore", "-c", NODE, str(domain)]
    process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "there\n"
    return process


def ports(process):
    files = f"/proc/{process.pid}/fd"
    paths = [os.readlink(f"{files}/{name}") for name in os.listdir(files)]
    return sorted(int(m[1]) for p in paths if (m := re.search(r"fastrtps_port(\d+)_el$", p)))


processes = [start(domain) for domain in DOMAINS]
found = [ports(process) for process in processes]
for process in processes:
    process.communicate("")
print(f"ros-jazzy-rclpy {version('ros-jazzy-rclpy')}")
for domain, numbers in zip(DOMAINS, found):
    of_domain = [n for n in numbers if 0 <= n - 7400 - 250 * domain < 250]
    shared = [n for n in numbers if 7000 <= n < 7400]
    print(f"domain {domain}: port of its own {of_domain}, port of the common range {shared}")
    assert len(of_domain) == len(shared) == 1, numbers
assert found[0][0] != found[1][0], "both have the same number: each domain counts for itself"
PYTHON
