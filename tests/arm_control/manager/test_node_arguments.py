"""Which of the process's ROS arguments a node takes over."""

import shlex

import pytest

from arm_control.manager.node_arguments import controller_arguments, manager_arguments

ARGV = shlex.split(
    "sim --world x --ros-args -r __node:=sim -r __ns:=/left --remap controller_manager:__node:=cm "
    "-r joint_states:=js -p robot_description:=<robot/> -p update_rate:=50 --params-file a.yaml "
    "--log-level info -- -r not:=ours"
)


def test_the_manager_keeps_its_namespace_but_not_the_processs_name():
    assert " ".join(manager_arguments(ARGV)) == (
        "--ros-args -r __ns:=/left --remap controller_manager:__node:=cm -r joint_states:=js "
        "-p robot_description:=<robot/> -p update_rate:=50 --params-file a.yaml"
    )


def test_a_controller_gets_neither_namespace_nor_description():
    taken = controller_arguments(ARGV, ["--ros-args", "-r", "a:=b"])
    assert " ".join(taken) == (
        "--ros-args --remap controller_manager:__node:=cm -r joint_states:=js -p update_rate:=50 "
        "--params-file a.yaml -r a:=b"
    )


@pytest.mark.parametrize("argv", [[], ["x"], ["x", "--ros-args"], ["x", "--ros-args", "-r"]])
def test_nothing_given_is_nothing_taken(argv):
    assert manager_arguments(argv) == ["--ros-args"]
