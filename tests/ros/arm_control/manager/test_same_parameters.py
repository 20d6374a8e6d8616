"""A parameter file means the same with and without ROS."""

from typing import Any

import pytest
import rclpy
from rclpy.context import Context
from rclpy.signals import SignalHandlerOptions

from arm_control.manager.controller_creation import MANAGER
from arm_control.manager.parameter_file import ParametersByNode
from arm_control.manager.ros.parameter_node import ParameterNode
from arm_gazebo.launching.controllers_file import read_controllers

VALUES = """
ctrl:
  ros__parameters:
    joints: [j0, j1]
    one: 1
    half: 0.5
    small: 1.0e-3
    yes_no: true
    text: 'on'
    numbers: [1.0, 2.5]
    whole: [1, 2]
    flags: [true, false]
    gains: {j0: {p: 100.0, i: 0.01}, j1.p: 5.0}
"""
NESTED = """
left:
  ctrl: {ros__parameters: {joints: [j0], deep: {deeper: {deepest: 1}}}}
  controller_manager: {ros__parameters: {update_rate: 50, ctrl: {type: a/B}}}
other: {ros__parameters: {x: 1}}
"""
ANYWHERE = """
/**: {ros__parameters: {x: 1, y: 1}}
ctrl: {ros__parameters: {y: 2}}
"""


@pytest.fixture(scope="module")
def context():
    made = Context()
    rclpy.init(context=made, signal_handler_options=SignalHandlerOptions.NO)
    yield made
    made.try_shutdown()


@pytest.mark.parametrize(
    ("text", "node", "namespace"),
    [
        (VALUES, "ctrl", "/"),
        (NESTED, "ctrl", "/left"),
        (NESTED, MANAGER, "/left"),
        (NESTED, "other", "/"),
        (ANYWHERE, "ctrl", "/"),
        (ANYWHERE, "ctrl", "/left"),
    ],
)
def test_a_node_and_a_program_get_the_same_values(context, tmp_path, text, node, namespace):
    path = tmp_path / "controllers.yaml"
    path.write_text(text + "typed: {ros__parameters: {type: a/B}}\n")
    made = ParameterNode(
        node,
        context=context,
        namespace=namespace,
        cli_args=["--ros-args", "--params-file", str(path)],
        use_global_arguments=False,
    )
    wanted = {name: plain(value) for name, value in made.given_parameters().items()}
    made.destroy_node()
    assert wanted
    parameters = ParametersByNode(read_controllers(path), "the file")
    assert parameters.given(node, namespace) == wanted


def plain(value: Any) -> Any:
    return list(value) if hasattr(value, "__len__") and not isinstance(value, str) else value
