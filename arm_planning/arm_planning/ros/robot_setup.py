"""The robot of move_group: its URDF, SRDF and limits from the node's parameters."""

import logging
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import String

from arm_description.resources import ResourceFinder
from arm_description.transforms import quaternion_from_rpy
from arm_description.urdf.parser import parse_urdf
from arm_node.qos import LATCHED
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.configuration import KINEMATICS, PLANNING, SEMANTIC
from arm_planning.errors import SettingError
from arm_planning.kinematics.group_kinematics import KinematicsSettings, kinematics_settings
from arm_planning.planner import resting_positions
from arm_planning.planners.pilz.cartesian_limits import CartesianLimits, cartesian_limits
from arm_planning.robot.build import planning_model
from arm_planning.robot.limits import joint_limit_settings
from arm_planning.robot.model import PlanningModel
from arm_planning.robot.srdf import parse_srdf, srdf_text
from arm_planning.scene.allowed_collisions import allowed_collisions
from arm_planning.scene.scene import PlanningScene
from arm_planning.setting_values import number, switch
from arm_planning.srdf_maker import make_srdf

URDF = "robot_description"
FOLLOW, POSE = "scene_from_world", "pose_in_world"
TOPIC_TIMEOUT_S = 10.0
LOGGER = logging.getLogger("move_group")


@dataclass(frozen=True, slots=True)
class PlanningSetup:
    """What move_group plans for.

    Attributes:
        model: the robot with its groups.
        scene: the scene at the start: without objects.
        srdf: text of the SRDF.
        meshes: cuts the meshes of the robot and of all scenes.
        tip_limits: speeds of a group's tip for Pilz' planners.
        seed: seed of all requests.
        in_world: pose of the robot's root in the simulated world whose things are objects of the
            scene; None if they are not.
        kinematics: settings of groups' inverse kinematics.
    """

    model: PlanningModel
    scene: PlanningScene
    srdf: str
    meshes: MeshPieces
    tip_limits: CartesianLimits
    seed: int
    in_world: RigidTransform | None
    kinematics: Mapping[str, KinematicsSettings] = field(default_factory=dict)


def planning_node(name: str) -> Node:
    """Return a node whose parameters are those that it is given, as upstream."""
    return Node(
        name,
        allow_undeclared_parameters=True,
        automatically_declare_parameters_from_overrides=True,
    )


def scene_node() -> Node:
    """Return the node of the scene's topics; upstream it has a number at the end, too."""
    return Node(f"move_group_private_{time.time_ns()}", enable_rosout=False)


def read_setup(node: Node) -> PlanningSetup:
    """Return the robot that the node's parameters describe, or the topic robot_description.

    Raises:
        PlanningError: there is no description, or the SRDF, a limit or a setting cannot be used.
        DescriptionError: the URDF cannot be used.
    """
    urdf = _text(node, URDF) or _from_topic(node, URDF)
    paths = [Path(part) for part in _text(node, "package_path").split(":") if part]
    meshes = MeshPieces(ResourceFinder.of_description(urdf, paths))
    robot = parse_urdf(urdf)
    srdf = _text(node, SEMANTIC)
    if not srdf:
        LOGGER.info("no robot_description_semantic is given: groups are made from the URDF")
        srdf = srdf_text(make_srdf(robot, LOGGER.warning, meshes=meshes))
    semantic = parse_srdf(srdf, robot)
    given = values_below(node, PLANNING)
    limits = joint_limit_settings(given, LOGGER.warning)
    model = planning_model(robot, semantic, limits, LOGGER.warning)
    scene = PlanningScene(resting_positions(model), allowed=allowed_collisions(semantic))
    kinematics = kinematics_settings(values_below(node, KINEMATICS), model, LOGGER.warning)
    return PlanningSetup(
        model,
        scene,
        srdf,
        meshes,
        cartesian_limits(given),
        _seed(node),
        _in_world(node),
        kinematics,
    )


def values_below(node: Node, prefix: str) -> dict[str, Any]:
    """Return the values of a node's parameters below a prefix, by the rest of their names."""
    found: dict[str, Any] = node.get_parameters_by_prefix(prefix)
    return {name: parameter.value for name, parameter in found.items()}


def _text(node: Node, name: str) -> str:
    value = node.get_parameter(name).value if node.has_parameter(name) else ""
    if not isinstance(value, str):
        raise SettingError(f"the parameter {name} is not a text")
    return value


def switch_of(node: Node, name: str, *, default: bool) -> bool:
    """Return a parameter that is true or false, or the default if it is not set.

    Raises:
        SettingError: it is neither.
    """
    value = node.get_parameter(name).value if node.has_parameter(name) else None
    return default if value is None else switch(name, value)


def _in_world(node: Node) -> RigidTransform | None:
    if not switch_of(node, FOLLOW, default=False):
        return None
    given: Any = node.get_parameter(POSE).value if node.has_parameter(POSE) else None
    given = (0.0,) * 6 if given is None or given == [] else given
    if isinstance(given, str) or not isinstance(given, Sequence) or len(given) != 6:
        raise SettingError(f"{POSE} is {given!r}; it is six numbers, x y z roll pitch yaw")
    x, y, z, *rpy = (number(POSE, each) for each in given)
    turned = quaternion_from_rpy(rpy).tolist()
    return RigidTransform((x, y, z), (turned[0], turned[1], turned[2], turned[3]))


def _seed(node: Node) -> int:
    value = node.get_parameter("seed").value if node.has_parameter("seed") else 0
    if not isinstance(value, int) or isinstance(value, bool) or value < 0:
        raise SettingError(f"seed is {value}; it is a whole number from 0")
    return value


def _from_topic(node: Node, topic: str) -> str:
    """Wait for a description on a topic, as upstream does for 10 s."""
    received: list[str] = []

    def take(message: String) -> None:
        received.append(message.data)

    subscription = node.create_subscription(String, topic, take, LATCHED)
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    deadline_s = time.monotonic() + TOPIC_TIMEOUT_S
    while not received and time.monotonic() < deadline_s and node.context.ok():
        executor.spin_once(0.1)
    executor.remove_node(node)
    node.destroy_subscription(subscription)
    if not received:
        raise SettingError(
            f"there is no robot: the parameter {topic} is empty, and nobody published the topic "
            f"{topic} within {TOPIC_TIMEOUT_S:g} s"
        )
    return received[0]
