"""Motion planning for a robot that runs, simulated or real: move_group, and servo_node."""

from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from launch_py import Action, DeclareLaunchArgument, LaunchDescription, Notified, ReadyPanel
from launch_py.actions import OpaqueFunction
from launch_py.errors import UsageError
from launch_py.launch_context import LaunchContext
from launch_py.ros import Node

INSTALL = "motion planning needs MoveIt's messages: pip install ./arm_moveit_interfaces"


def move_group(context: LaunchContext) -> list[Action]:
    """Return the node with its configuration.

    Raises:
        UsageError: the configuration cannot be used, or MoveIt's messages are not installed.
    """
    # Imported here, so that --show-args needs only this file.
    from arm_description.errors import DescriptionError
    from arm_description.resources import ResourceFinder
    from arm_planning.configuration import move_group_parameters
    from arm_planning.errors import PlanningError

    words = context.launch_configurations
    if find_spec("moveit_msgs") is None:
        raise UsageError(INSTALL)
    configured = {}
    octomap = words["octomap"] == "true"
    if octomap and not words["moveit_config"]:
        raise UsageError("octomap:=true needs moveit_config, a folder with sensors_3d.yaml")
    if words["moveit_config"]:
        try:
            given = words["moveit_config"]
            folder = ResourceFinder().find(given) if "://" in given else Path(given).expanduser()
            configured = move_group_parameters(folder, octomap=octomap)
        except (PlanningError, DescriptionError) as error:
            raise UsageError(f"moveit_config:={words['moveit_config']}: {error}") from error
    robot = {
        "robot_description": words.get("planning_description", ""),
        "use_sim_time": words["use_sim_time"] == "true",
        "package_path": words.get("package_path", ""),
    }
    own: dict[str, Any] = {
        **robot,
        "seed": seed(words["planning_seed"]),
        "scene_from_world": words["scene_from_world"] == "true",
    }
    if place := numbers(words.get("pose", "")):
        own["pose_in_world"] = place
    above = in_root(words.get("namespace", ""))
    return [
        Node(
            package="arm_planning",
            executable="move_group",
            namespace=words.get("namespace", ""),
            parameters=[{**configured, **own}],
            ready=Notified(),
        ),
        ReadyPanel(
            title="Motion planning is up",
            topics=[
                (f"{above}/move_action", "moveit_msgs/action/MoveGroup, as MoveIt's move_group")
            ],
            commands=[("move", f"arm move -n {above} --help" if above else "arm move --help")],
        ),
        *(servo(words, {**configured, **robot}) if words["servo"] == "true" else ()),
    ]


def servo(words: Mapping[str, str], robot: Mapping[str, Any]) -> list[Action]:
    """Return the node that jogs the robot.

    Raises:
        UsageError: its file of parameters cannot be used.
    """
    from arm_planning.configuration import servo_parameters
    from arm_planning.errors import PlanningError

    configured: dict[str, Any] = {}
    if words["servo_config"]:
        try:
            configured = servo_parameters(Path(words["servo_config"]).expanduser())
        except PlanningError as error:
            raise UsageError(f"servo_config:={words['servo_config']}: {error}") from error
    above = in_root(words.get("namespace", ""))
    return [
        Node(
            package="arm_planning",
            executable="servo_node",
            namespace=words.get("namespace", ""),
            parameters=[{**robot, **configured}],
            ready=Notified(),
        ),
        ReadyPanel(
            title="The jog is up",
            topics=[
                (f"{above}/servo_node/delta_twist_cmds", "geometry_msgs/msg/TwistStamped"),
                (f"{above}/servo_node/delta_joint_cmds", "control_msgs/msg/JointJog"),
                (f"{above}/servo_node/status", "moveit_msgs/msg/ServoStatus"),
            ],
        ),
    ]


def in_root(namespace: str) -> str:
    """Return a namespace as names on the graph begin: "/left", or "" for none."""
    return f"/{namespace.strip('/')}".rstrip("/")


def numbers(text: str) -> list[float]:
    """Return the numbers of a pose as the launch files write it: "x y z ..." or "[x, y, z, ...]".

    The simulation itself says what is wrong with a pose.
    """
    try:
        return [float(word) for word in text.replace(",", " ").strip("[] ").split()]
    except ValueError:
        return []


def seed(text: str) -> int:
    """Return the seed in an argument.

    Raises:
        UsageError: it is no whole number from 0.
    """
    if not text.isdecimal():
        raise UsageError(f"planning_seed:={text} is not a whole number from 0")
    return int(text)


def generate_launch_description() -> LaunchDescription:
    """Return the node and its arguments."""
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "namespace", default_value="", description="namespace of the nodes and the robot"
            ),
            DeclareLaunchArgument(
                "moveit_config",
                default_value="",
                description="folder of a MoveIt configuration: SRDF, joint_limits.yaml, "
                "kinematics.yaml, moveit_controllers.yaml; by default all is made from the URDF",
            ),
            DeclareLaunchArgument(
                "planning_seed",
                default_value="0",
                description="seed of the planners: the same request gets the same plan",
            ),
            DeclareLaunchArgument(
                "scene_from_world",
                default_value="false",
                choices=["true", "false"],
                description="the simulation's things are objects of the planning scene, as they "
                "move; for a robot whose base is fixed",
            ),
            DeclareLaunchArgument(
                "octomap",
                default_value="false",
                choices=["true", "false"],
                description="what the depth cameras in the configuration's sensors_3d.yaml see is "
                "an octomap of the planning scene",
            ),
            DeclareLaunchArgument(
                "servo",
                default_value="false",
                choices=["true", "false"],
                description="start servo_node, too, which jogs the robot as moveit_servo does",
            ),
            DeclareLaunchArgument(
                "servo_config",
                default_value="",
                description="YAML file with parameters of moveit_servo",
            ),
            DeclareLaunchArgument(
                "use_sim_time",
                default_value="true",
                choices=["true", "false"],
                description="the node uses the time of the joint states' stamps",
            ),
            OpaqueFunction(function=move_group),
        ]
    )
