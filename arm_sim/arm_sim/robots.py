"""The robots that have a name, as the launch files of these robots set them up."""

from collections.abc import Mapping
from dataclasses import field
from os import PathLike

from arm_node.frozen import frozen

AnyPath = str | PathLike[str]


@frozen
class NamedRobot:
    """A robot with its controllers and the world that it starts in.

    Attributes:
        model: URI of the xacro file.
        controllers: URI of the parameter file.
        spawn: controllers to start.
        world: name of a shipped world.
        arguments: xacro arguments.
        pose: x y z roll pitch yaw of its root in the world, in m and rad; () for the default.
        moveit_config: package and folder of its MoveIt configuration; "" to make one from its URDF.
    """

    model: str
    controllers: str
    spawn: tuple[str, ...]
    world: str = "empty"
    arguments: Mapping[str, str] = field(default_factory=dict[str, str])
    pose: tuple[float, ...] = ()
    moveit_config: str = ""


NAMED_ROBOTS: Mapping[str, NamedRobot] = {
    "arm": NamedRobot(
        "package://arm_description/urdf/arm.urdf.xacro",
        "package://arm_control/config/arm_control.yaml",
        ("joint_state_broadcaster", "position_controller"),
    ),
    "mycobot": NamedRobot(
        "package://mycobot_description/urdf/robots/mycobot_280.urdf.xacro",
        "package://mycobot_moveit_config/config/mycobot_280/ros2_controllers_template.yaml",
        ("joint_state_broadcaster", "arm_controller", "gripper_action_controller"),
        "pick_and_place_demo",
        {"use_gazebo": "true"},
        (0.0, 0.0, 0.025, 0.0, 0.0, 0.0),
        "package://mycobot_moveit_config/config/mycobot_280",
    ),
}
"""By name; `arm_gazebo.launch.py` and `mycobot.gazebo.launch.py` start them over ROS."""
