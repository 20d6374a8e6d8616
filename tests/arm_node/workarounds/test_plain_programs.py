"""A program of plain rclpy gets a first node that is found at once and that others can reach."""

import subprocess
import sys

import pytest

from launch_py.system.packages import Packages

pytestmark = [pytest.mark.ros, pytest.mark.workaround("lost_ports")]

PRELOAD = """
from arm_node.workarounds.plain_programs import reach_first_node
reach_first_node()
"""
LOSES_ITS_PORTS_ONCE = """
from arm_node.workarounds import discovery
answers = iter([["/dev/shm/fastrtps_port7411"], [], ["never asked"]])
discovery.lost_ports = lambda: next(answers)
"""
PLAIN = """
import rclpy
rclpy.init()
first, second = rclpy.create_node("first"), rclpy.create_node("second")
names = sorted(first.get_node_names())
first.destroy_node()
second.destroy_node()
rclpy.shutdown()
"""
BAD_NAME = """
import rclpy
from rclpy.exceptions import InvalidNodeNameException
rclpy.init()
try:
    rclpy.create_node("a name")
except InvalidNodeNameException as error:
    names = type(error).__name__, rclpy.create_node("a_name").get_name()
rclpy.shutdown()
"""


def printed(code: str) -> str:
    command = [sys.executable, "-W", "ignore", "-c", code]
    return subprocess.check_output(command, text=True, timeout=60)


def test_a_node_whose_ports_are_lost_is_made_again():
    show = "print(names, next(answers))"
    shown = printed(PRELOAD + LOSES_ITS_PORTS_ONCE + PLAIN + show)
    assert shown == "['first', 'second'] ['never asked']\n"


def test_without_the_preload_nobody_looks():
    show = "print(names, next(answers))"
    shown = printed(LOSES_ITS_PORTS_ONCE + PLAIN + show)
    assert shown == "['first', 'second'] ['/dev/shm/fastrtps_port7411']\n"


def test_a_wrong_name_is_refused_as_ever():
    shown = printed(PRELOAD + BAD_NAME + "print(*names)")
    assert shown == "InvalidNodeNameException a_name\n"


def test_it_is_on_in_each_python_program_that_is_started():
    command = Packages({}).executable("arm_controller", "arm_gripper_loop_controller")
    assert "from arm_node.workarounds.plain_programs import reach_first_node" in command[-1]
