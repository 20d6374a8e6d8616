"""`arm launch domain:=auto`: several simulations on one machine never hear each other."""

import os
import re
import subprocess
import sys

import pytest

pytestmark = pytest.mark.ros

TIMEOUT_S = 60.0


def test_two_launches_do_not_hear_each_other(launch):
    both = [launch("domain:=auto", "camera:=none") for _ in range(2)]
    domains = []
    for launched in both:
        launched.wait_until_ready()
        found = re.search(r"ROS_DOMAIN_ID=(\d+); export it", launched.output)
        assert found, launched.output
        domains.append(found[1])
    assert domains[0] != domains[1]
    assert os.environ["ROS_DOMAIN_ID"] not in domains
    nodes = subprocess.run(
        [sys.executable, "-m", "arm_cli", "node", "list"],
        env={**os.environ, "ROS_DOMAIN_ID": domains[0]},
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
    )
    assert nodes.stdout.splitlines().count("/arm_controller_node") == 1, nodes.stdout
    # Nothing was said of a second node of a name, which would stop the later launch.
    assert [launched.stop() for launched in both] == [0, 0]
