"""Any robot without physics: its frames, and the page in the browser whose sliders move it."""

import shutil

from launch_py import (
    DeclareLaunchArgument,
    ExecuteProcess,
    IncludeLaunchDescription,
    LaunchDescription,
    Notified,
    SetLaunchConfiguration,
)
from launch_py.conditions import IfCondition, UnlessCondition
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare, Node, ParameterValue
from launch_py.substitutions import Call, LaunchConfiguration, PathJoinSubstitution


def describe(model: str, camera: str) -> str:
    """Return the URDF text of the model."""
    from arm_description.xacro_expansion import expand_xacro

    return expand_xacro(model, {"camera": camera})


def page() -> IncludeLaunchDescription:
    """Return the page, whose sliders stand for the robot."""
    file = PathJoinSubstitution([FindPackageShare("arm_viewer"), "launch", "viewer.launch.py"])
    return IncludeLaunchDescription(
        PythonLaunchDescriptionSource(file),
        launch_arguments={"publish_joint_states": "true"},
        condition=IfCondition(LaunchConfiguration("viewer")),
    )


def generate_launch_description() -> LaunchDescription:
    """Return the state publisher, what publishes joint states, the page and RViz."""
    share = FindPackageShare("arm_description")
    model = PathJoinSubstitution([share, "urdf", "arm.urdf.xacro"])
    description = ParameterValue(LaunchConfiguration("robot_description"), value_type=str)
    return LaunchDescription(
        [
            DeclareLaunchArgument("model", default_value=model, description="URDF or xacro file"),
            DeclareLaunchArgument(
                "camera",
                default_value="front",
                description="the arm's camera",
                choices=["front", "side", "none"],
            ),
            DeclareLaunchArgument(
                "viewer",
                default_value="true",
                description="open the page in the browser; false: joint_state_publisher instead",
                choices=["true", "false"],
            ),
            DeclareLaunchArgument(
                "use_rviz",
                default_value="true" if shutil.which("rviz2") else "false",
                description="start RViz; it comes with a ROS 2 installation",
                choices=["true", "false"],
            ),
            DeclareLaunchArgument(
                "rviz_config_file",
                default_value=PathJoinSubstitution([share, "config", "rviz", "arm.rviz"]),
                description="what RViz shows",
            ),
            SetLaunchConfiguration(
                "robot_description",
                Call(describe, LaunchConfiguration("model"), LaunchConfiguration("camera")),
            ),
            Node(
                package="arm_description",
                executable="robot_state_publisher",
                parameters=[{"robot_description": description}],
                ready=Notified(),
            ),
            Node(
                package="arm_description",
                executable="joint_state_publisher",
                parameters=[{"robot_description": description}],
                ready=Notified(),
                condition=UnlessCondition(LaunchConfiguration("viewer")),
            ),
            page(),
            ExecuteProcess(
                cmd=["rviz2", "-d", LaunchConfiguration("rviz_config_file")],
                name="rviz2",
                condition=IfCondition(LaunchConfiguration("use_rviz")),
            ),
        ]
    )
