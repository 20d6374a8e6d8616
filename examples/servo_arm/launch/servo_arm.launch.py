"""Starts fake servos, a controller manager that drives them, and its controllers."""

from launch_py import (
    DeclareLaunchArgument,
    Finished,
    LaunchDescription,
    LogLine,
    Notified,
    SetLaunchConfiguration,
)
from launch_py.ros import FindPackageShare, Node, ParameterValue
from launch_py.substitutions import Call, LaunchConfiguration, PathJoinSubstitution


def describe(model: str, device: str, timeout: str) -> str:
    """Return the URDF with the servos' port and their timeout."""
    from arm_description import expand_xacro

    return expand_xacro(model, {"device": device, "timeout": timeout})


def generate_launch_description() -> LaunchDescription:
    """Return the processes; each starts when those that it depends on are ready."""
    share = FindPackageShare("servo_arm")
    device = LaunchConfiguration("device")
    description = ParameterValue(LaunchConfiguration("robot_description"), value_type=str)
    servos = Node(
        package="servo_arm",
        executable="fake_servo",
        arguments=["--link", device],
        respawn=True,
        ready=LogLine("servos at"),
    )
    manager = Node(
        package="arm_control",
        executable="ros2_control_node",
        parameters=[PathJoinSubstitution([share, "config", "controllers.yaml"])],
        ready=Notified(),
        depends_on=servos,
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "device", default_value="/tmp/servo_arm", description="path of the servos' port"
            ),
            DeclareLaunchArgument(
                "timeout",
                default_value="0.2",
                description="how long an answer of the servos may take, in seconds",
            ),
            SetLaunchConfiguration(
                "robot_description",
                Call(
                    describe,
                    PathJoinSubstitution([share, "urdf", "servo_arm.urdf.xacro"]),
                    device,
                    LaunchConfiguration("timeout"),
                ),
            ),
            servos,
            Node(
                package="arm_description",
                executable="robot_state_publisher",
                parameters=[{"robot_description": description}],
                ready=Notified(),
            ),
            manager,
            Node(
                package="arm_control",
                executable="spawner",
                arguments=["joint_state_broadcaster", "pd_controller"],
                ready=Finished(),
                depends_on=manager,
            ),
        ]
    )
