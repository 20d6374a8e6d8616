"""The arm without physics: ros2_control_node with mock hardware that follows every command."""

from launch_py import (
    DeclareLaunchArgument,
    Finished,
    LaunchDescription,
    Notified,
    SetLaunchConfiguration,
)
from launch_py.ros import FindPackageShare, Node, ParameterValue
from launch_py.substitutions import Call, LaunchConfiguration, PathJoinSubstitution


def describe(model: str, hardware: str) -> str:
    """Return the URDF text of the model."""
    from arm_description.xacro.expansion import expand_xacro

    return expand_xacro(model, {"hardware": hardware, "camera": "none"})


def generate_launch_description() -> LaunchDescription:
    """Return the state publisher, the controller manager and a spawner."""
    model = PathJoinSubstitution([FindPackageShare("arm_description"), "urdf", "arm.urdf.xacro"])
    controllers = PathJoinSubstitution(
        [FindPackageShare("arm_control"), "config", "arm_control.yaml"]
    )
    description = ParameterValue(LaunchConfiguration("robot_description"), value_type=str)
    manager = Node(
        package="arm_control",
        executable="ros2_control_node",
        parameters=[LaunchConfiguration("controllers")],
        ready=Notified(),
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument("model", default_value=model, description="URDF or xacro file"),
            DeclareLaunchArgument(
                "hardware",
                default_value="mock_components/GenericSystem",
                description="hardware plugin, the xacro argument `hardware`",
            ),
            DeclareLaunchArgument(
                "controllers",
                default_value=controllers,
                description="parameter file of the controller manager and its controllers",
            ),
            SetLaunchConfiguration(
                "robot_description",
                Call(describe, LaunchConfiguration("model"), LaunchConfiguration("hardware")),
            ),
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
                arguments=["joint_state_broadcaster", "position_controller"],
                ready=Finished(),
                depends_on=manager,
            ),
        ]
    )
