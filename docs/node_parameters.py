"""The parameters of the suite's nodes, as the nodes themselves declare them.

Each node is made in a ROS domain that nobody else uses and is asked to describe its parameters; it
never runs.
"""

from array import array
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import rclpy
from ament_index_python.packages import get_package_share_directory
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from arm_control.manager.settings import ManagerSettings
from arm_control.parameters import ParameterSpec, specs_of
from arm_controller.arm_controller_node import ArmController
from arm_controller.arm_gripper_loop_controller_node import ArmGripperLoopController
from arm_controller.example_gripper_node import GripperTest
from arm_controller.pick_and_place_node import PickAndPlaceNode
from arm_controller.publisher_defined_node import PublisherDefined
from arm_controller.publisher_terminal_node import PublisherTerminal
from arm_description.publishers.ros_joint_state_publisher import JointStatePublisher
from arm_description.publishers.ros_robot_state_publisher import RobotStatePublisher
from arm_gazebo.ros.live_parameters import declare_faults
from arm_gazebo.run.settings import simulation_settings
from arm_node.parameters import declare_setting
from arm_viewer.ros.viewer import Viewer

QUIET_DOMAIN = 101
ROBOT = "<robot name='robot'><link name='link'/></robot>"
OF_EVERY_NODE = ("start_type_description_service", "use_sim_time")
QOS = "qos_overrides."
TYPES = ("", "bool", "int", "float", "str", "list", "list", "list", "list", "list")
"""Python's names of the types, by the number in rcl_interfaces/msg/ParameterType."""
SAID_BY_THE_TYPE = ("true or false", "a text", "a whole number", "a finite number")


@dataclass(frozen=True, slots=True)
class Parameter:
    """A row of a table of parameters.

    Attributes:
        name: the name, with dots.
        type: Python's name of the type.
        default: the default as Python prints it, empty if there is none.
        takes: what the value must be, unless the type says it all.
        settable: when it can be set.
        meaning: its description.
    """

    name: str
    type: str
    default: str
    takes: str
    settable: str
    meaning: str


def _ignore(*_: Any) -> None:
    """Do nothing: the nodes never run."""


NODES: tuple[tuple[Callable[[], Node], str], ...] = (
    (
        RobotStatePublisher,
        "Publishes the poses of the links, and the description. The QoS of its topics can be "
        "overridden, as in ROS 2: `qos_overrides./tf.publisher.depth`.",
    ),
    (
        lambda: JointStatePublisher(None, _ignore),
        "Publishes joint states for a robot that is not running. `zeros.JOINT` is the initial "
        "position of a joint; `dependent_joints.JOINT.parent`, `.factor` and `.offset` make a "
        "joint follow another one.",
    ),
    (Viewer, "Serves the page in the browser."),
    (ArmController, "Sends the pose in its parameter `desired_param` each time that is set."),
    (PublisherTerminal, "Sends the poses that the user types."),
    (PublisherDefined, "Sends the poses of a file, one after the other."),
    (ArmGripperLoopController, "Moves the myCobot back and forth, and its gripper."),
    (PickAndPlaceNode, "Picks the red cylinder up and puts it back."),
    (
        GripperTest,
        "Closes the gripper of the demo. `diff_drive_test_node`, which drives the demo on two "
        "wheels, has the same parameter.",
    ),
)
"""A function that creates each node, and what the node does."""


def parameter_table(parameters: Sequence[Parameter]) -> list[str]:
    """Return a Markdown table."""
    lines = ["| parameter | type | default | range | set | meaning |", "|---|---|---|---|---|---|"]
    for row in parameters:
        default = f"`{row.default}`" if row.default else ""
        cells = (
            f"`{row.name}`",
            row.type,
            default,
            _escaped(row.takes),
            row.settable,
            _escaped(row.meaning),
        )
        lines.append(f"| {' | '.join(cells)} |")
    return [*lines, ""]


def _escaped(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;")


def parameter_of(spec: ParameterSpec) -> Parameter:
    """Return the row of a parameter that a dataclass declares."""
    name = spec.type.__name__
    default = list(spec.default) if spec.is_list else spec.default
    settable = "read when configured" if spec.at_configuration else "any time"
    return Parameter(
        spec.name,
        f"list of {name}" if spec.is_list else name,
        repr(default),
        spec.constraint,
        "at the start" if spec.read_only else settable,
        spec.description,
    )


def node_parameters_page() -> str:
    """Return the page: a section for each node."""
    lines = [
        "# Parameters of the nodes",
        "",
        "The nodes declare their parameters as shown here; `arm param describe NODE NAME` prints "
        "the same. Every node also has `use_sim_time` and `start_type_description_service`. The "
        "parameters of controllers are on [another page](controllers.md).",
        "",
    ]
    with _quiet_ros():
        node = Node("arm_gazebo")
        simulation_settings(partial(declare_setting, node))
        declare_faults(node)
        lines += _section(
            node,
            "The simulation. With several `robots`, the parameters of each robot, from "
            "`robot_description` to `package_path`, begin with its namespace: `left.base`.",
        )
        lines += ["## controller_manager", "", "Runs in the simulation and in ros2_control_node."]
        lines += ["", *parameter_table([parameter_of(s) for s in specs_of(ManagerSettings)])]
        for make, about in NODES:
            lines += _section(make(), about)
    return "\n".join(lines)


def _section(node: Node, about: str) -> list[str]:
    """Return the section about a node, and destroy the node."""
    lines = [f"## {node.get_name()}", "", about, "", *parameter_table(_described(node))]
    node.destroy_node()
    return lines


@contextmanager
def _quiet_ros() -> Iterator[None]:
    """Run ROS in a domain of its own while the context lasts."""
    rclpy.init(
        args=["--ros-args", "-p", f"robot_description:={ROBOT}"],
        domain_id=QUIET_DOMAIN,
        signal_handler_options=SignalHandlerOptions.NO,
    )
    try:
        yield
    finally:
        rclpy.shutdown()


def _described(node: Node) -> list[Parameter]:
    """Return the parameters of a node, without those of every node."""
    names = [
        name
        for name in node.get_parameters_by_prefix("")
        if name not in OF_EVERY_NODE and not name.startswith(QOS)
    ]
    return [_described_by(node, descriptor) for descriptor in node.describe_parameters(names)]


def _described_by(node: Node, descriptor: ParameterDescriptor) -> Parameter:
    takes = descriptor.additional_constraints
    for bounds in descriptor.floating_point_range:
        takes = takes or f"from {bounds.from_value:g} to {bounds.to_value:g}"
    return Parameter(
        descriptor.name,
        TYPES[descriptor.type] or ("list" if takes.startswith("a list") else ""),
        _default(node.get_parameter(descriptor.name).value),
        "" if takes in SAID_BY_THE_TYPE else takes,
        "at the start" if descriptor.read_only else "any time",
        descriptor.description,
    )


def _default(value: Any) -> str:
    """Return a default as Python prints it, without this machine's folders; empty for none."""
    if value is None:
        return ""
    if value == ROBOT:
        return "''"
    if isinstance(value, array):
        value = value.tolist()
    share = Path(get_package_share_directory("arm_controller")).parent
    return repr(value).replace(str(share), "share")
