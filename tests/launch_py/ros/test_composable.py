"""Composable nodes start as programs where there are any; the others are named and skipped."""

import os

import pytest

from launch_py import LaunchDescription
from launch_py.conditions import IfCondition
from launch_py.launch_description import expand_description
from launch_py.ros import (
    ComposableLifecycleNode,
    ComposableNode,
    ComposableNodeContainer,
    LoadComposableNodes,
    Node,
)

PUBLISHER = {
    "package": "robot_state_publisher",
    "plugin": "robot_state_publisher::RobotStatePublisher",
}


@pytest.fixture
def plan():
    return lambda *actions: expand_description(LaunchDescription(actions), {}, dict(os.environ))


def container(*nodes, **options) -> ComposableNodeContainer:
    return ComposableNodeContainer(
        name="box",
        namespace="left",
        package="rclcpp_components",
        executable="component_container_mt",
        composable_node_descriptions=nodes,
        **options,
    )


def test_a_component_that_has_a_program_starts_as_that_program(plan):
    made = plan(
        container(
            ComposableNode(
                **PUBLISHER,
                name="rsp",
                namespace="left",
                parameters=[{"robot_description": "<robot/>"}],
                remappings=[("joint_states", "js")],
                extra_arguments=[{"use_intra_process_comms": True}],
            )
        )
    )
    (step,) = made.processes
    words = " ".join(map(str, step.command))
    assert "from arm_description.robot_state_publisher_node import main" in words
    assert "__node:=rsp -r __ns:=/left --params-file" in words
    assert words.endswith("-r joint_states:=js")
    assert made.warnings == ()


def test_a_component_without_a_program_is_named_and_the_rest_starts(plan):
    rectify = ComposableNode(package="image_proc", plugin="image_proc::RectifyNode", name="rectify")
    own = ComposableNode(package="nowhere", plugin="own::Node")
    off = ComposableNode(package="nowhere", plugin="off::Node", condition=IfCondition("false"))
    made = plan(
        container(rectify, ComposableNode(**PUBLISHER), off),
        LoadComposableNodes(composable_node_descriptions=[own], target_container="box"),
        Node(executable="true"),
    )
    assert [step.name for step in made.processes][1:] == ["true"]
    assert len(made.processes) == 2
    assert made.warnings == (
        "the composable node rectify, image_proc::RectifyNode of image_proc is skipped: no program "
        "here does its work, and a C++ component cannot be loaded",
        "the composable node own::Node of nowhere is skipped: no program here does its work, and a "
        "C++ component cannot be loaded",
    )


def test_a_managed_component_is_started_as_a_managed_node(plan):
    made = plan(container(ComposableLifecycleNode(**PUBLISHER, name="rsp", autostart=True)))
    assert [step.name for step in made.processes] == ["rsp", "configure activate /rsp"]


def test_a_condition_switches_the_whole_container_off(plan):
    assert plan(container(ComposableNode(**PUBLISHER), condition=IfCondition("0"))).processes == ()
