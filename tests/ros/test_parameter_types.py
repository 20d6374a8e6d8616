"""Every parameter of every node of the suite has one type, which no client changes."""

import ast
import json
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import rclpy
import yaml
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions

from arm_control.controllers.controller import ControllerContext
from arm_control.manager.registry import controller_class
from arm_control.manager.ros.controller_manager_node import ControllerManagerNode
from arm_control.manager.ros.controller_node import ControllerNode
from arm_controller.arm_controller_node import ArmController
from arm_controller.arm_gripper_loop_controller_node import ArmGripperLoopController
from arm_controller.example_diff_drive_node import DiffDriveTest
from arm_controller.example_gripper_node import GripperTest
from arm_controller.hello_moveit_node import HelloMoveIt
from arm_controller.pick_and_place_node import PickAndPlaceNode
from arm_controller.plan_around_objects_node import PlanAroundObjects
from arm_controller.publisher_defined_node import PublisherDefined
from arm_controller.publisher_terminal_node import PublisherTerminal
from arm_description.publishers.ros_joint_state_publisher import JointStatePublisher
from arm_description.publishers.ros_robot_state_publisher import RobotStatePublisher
from arm_description.static_transform_publisher_node import _node as static_transform
from arm_gazebo.ros.live_parameters import declare_faults
from arm_gazebo.run.settings import simulation_settings
from arm_node.parameters import declare_setting
from arm_viewer.ros.viewer import Viewer

ROOT = Path(__file__).parents[2]
CONTROLLERS: dict[str, Any] = yaml.safe_load(
    (Path(__file__).parent / "arm_control/manager/parameter_surface.yaml").read_text()
)
ROBOT = "<robot name='robot'><link name='link'/></robot>"
GIVEN = {
    "robot_description": ROBOT,
    "zeros.elbow": "1",
    "dependent_joints.finger.parent": "thumb",
    "dependent_joints.finger.factor": "2",
    "dependent_joints.finger.offset": "0.1",
    "some_controller.type": "position_controllers/JointGroupPositionController",
    "some_controller.node_options_args": "[]",
    "pose": "[0, 0, 1, 0, 0, 0]",
    "spawn": "one,two",
}
OF_RCLPY = ("start_type_description_service", "use_sim_time", "qos_overrides.")
VALUES = (True, 7, 7.5, "word", [b"x"], [True], [7], [7.5], ["word"])
PROCESS: Any = SimpleNamespace(stopping=False)


def simulation_node() -> Node:
    node = Node("arm_gazebo")
    simulation_settings(partial(declare_setting, node))
    declare_faults(node)
    return node


def controller_node(type_name: str) -> Node:
    context = ControllerContext.of("made", 100, "")
    given = CONTROLLERS[type_name].get("given", {})
    arguments = ["--ros-args"]
    for name, value in given.items():
        arguments += ["-p", f"{name}:={json.dumps(value)}"]
    return ControllerNode(
        controller_class(type_name)(context), type_name, "", arguments, PROCESS, lambda _: None
    )


MAKERS: dict[str, Callable[[], Node]] = {
    "RobotStatePublisher": RobotStatePublisher,
    "JointStatePublisher": lambda: JointStatePublisher(None, lambda: None),
    "Viewer": Viewer,
    "ArmController": ArmController,
    "PublisherTerminal": PublisherTerminal,
    "PublisherDefined": PublisherDefined,
    "ArmGripperLoopController": ArmGripperLoopController,
    "PickAndPlaceNode": PickAndPlaceNode,
    "HelloMoveIt": HelloMoveIt,
    "PlanAroundObjects": PlanAroundObjects,
    "GripperTest": GripperTest,
    "DiffDriveTest": DiffDriveTest,
    "ControllerManagerNode": lambda: ControllerManagerNode(["manager", *given_arguments()]),
    "arm_gazebo": simulation_node,
    "static_transform_publisher": lambda: static_transform(
        {"frame_id": "a", "child_frame_id": "b"}
    ),
    **{name: partial(controller_node, name) for name in CONTROLLERS},
}


def given_arguments() -> list[str]:
    return ["--ros-args", *(word for pair in GIVEN.items() for word in ("-p", ":=".join(pair)))]


@pytest.fixture
def ros() -> Iterator[None]:
    rclpy.init(args=given_arguments(), signal_handler_options=SignalHandlerOptions.NO)
    yield
    rclpy.shutdown()


def described(node: Node) -> dict[str, str]:
    names = node.list_parameters([], 0).names
    return {name: str(node.describe_parameter(name)) for name in names}


@pytest.mark.parametrize("maker", MAKERS)
def test_a_value_of_a_wrong_type_is_refused_and_changes_no_description(ros, maker):
    node = MAKERS[maker]()
    before = described(node)
    values = {name: node.get_parameter(name).value for name in before}
    for name in before:
        for value in VALUES:
            given = Parameter(name, value=value)
            if (
                given.type_.value == node.describe_parameter(name).type
                or name == "robot_description"
            ):
                continue
            if (maker, name, value) == ("ArmController", "desired_param", [7]):
                continue  # A pose in whole numbers is converted to the parameter's type.
            result = node.set_parameters_atomically([given])
            assert not result.successful, (name, value)
            assert result.reason
    assert described(node) == before
    assert {name: node.get_parameter(name).value for name in before} == values
    node.destroy_node()


@pytest.mark.parametrize("maker", MAKERS)
def test_each_has_a_type_and_a_description(ros, maker):
    node = MAKERS[maker]()
    for name in described(node):
        descriptor = node.describe_parameter(name)
        assert descriptor.type != Parameter.Type.NOT_SET.value, name
        assert not descriptor.dynamic_typing, name
        assert descriptor.description or name.startswith(OF_RCLPY), name
    node.destroy_node()


def test_no_node_is_left_out():
    bases = {"Node", "ParameterNode"}
    found = {
        item.name
        for path in ROOT.glob("arm_*/arm_*/**/*.py")
        for item in ast.walk(ast.parse(path.read_text()))
        if isinstance(item, ast.ClassDef)
        and bases & {base.id for base in item.bases if isinstance(base, ast.Name)}
    }
    assert found - {"ParameterNode", "ControllerNode"} <= set(MAKERS)


def test_an_integer_is_no_frequency(ros):
    node = RobotStatePublisher()
    node.set_parameters_atomically([Parameter("publish_frequency", value=20)])
    descriptor = node.describe_parameter("publish_frequency")
    assert (descriptor.type, node.get_parameter("publish_frequency").value) == (3, 20.0)
    (bounds,) = descriptor.floating_point_range
    assert (bounds.from_value, bounds.to_value) == (0.0, 1000.0)
    node.destroy_node()


def test_given_values_are_stored_in_the_type(ros):
    publisher, simulation = JointStatePublisher(None, lambda: None), simulation_node()
    elbow = publisher.get_parameter("zeros.elbow")
    assert (elbow.type_, elbow.value) == (Parameter.Type.DOUBLE, 1.0)
    assert list(simulation.get_parameter("pose").value) == [0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
    assert simulation.get_parameter("spawn").value == ["one", "two"]
    publisher.destroy_node()
    simulation.destroy_node()


def test_the_type_of_a_controller_is_a_text(ros):
    node = MAKERS["ControllerManagerNode"]()
    refused, taken = (
        node.set_parameters_atomically([Parameter("new_controller.type", value=value)])
        for value in (5, "a/B")
    )
    assert (refused.successful, taken.successful) == (False, True)
    assert "must be a text" in refused.reason
    assert node.describe_parameter("new_controller.type").type == Parameter.Type.STRING.value
    node.destroy_node()


@pytest.mark.parametrize(
    ("value", "stored"),
    [([7, 0, 1, 2], [7.0, 0.0, 1.0, 2.0]), ([], []), ("[0, 0.5, 1, 1]", [0.0, 0.5, 1.0, 1.0])],
)
def test_a_pose_keeps_its_type_in_any_notation(ros, value, stored):
    node = ArmController()
    before = described(node)
    assert node.get_parameter("desired_param").value == []
    result = node.set_parameters_atomically([Parameter("desired_param", value=value)])
    assert (result.successful, result.reason) == (True, "")
    assert list(node.get_parameter("desired_param").value) == stored
    assert described(node) == before
    node.destroy_node()
