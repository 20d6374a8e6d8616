# Expressions over arguments in conditions, namespaces for each arm, a gripper that is included.
# starts: joint_state_publisher robot_state_publisher gripper
# arguments: load_gripper:=true namespace:=left
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, Shutdown
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, PythonExpression
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription


def generate_launch_description():
    namespace = LaunchConfiguration("namespace")
    has_gripper = LaunchConfiguration("load_gripper")
    wanted = PythonExpression(["'", has_gripper, "'.lower() == 'true' and '", namespace, "' != ''"])
    return LaunchDescription(
        [
            DeclareLaunchArgument("load_gripper", default_value="false"),
            DeclareLaunchArgument("namespace", default_value=""),
            Node(
                package="joint_state_publisher",
                executable="joint_state_publisher",
                name="joint_state_publisher",
                namespace=namespace,
                parameters=[
                    {"source_list": ["arm/joint_states", "gripper/joint_states"], "rate": 30}
                ],
            ),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                namespace=namespace,
                on_exit=Shutdown(),
            ),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(
                    PathJoinSubstitution(
                        [FindPackageShare("demo_arm"), "launch", "gripper.launch.py"]
                    )
                ),
                launch_arguments={"namespace": namespace, "joint": "finger"}.items(),
                condition=IfCondition(wanted),
            ),
        ]
    )
