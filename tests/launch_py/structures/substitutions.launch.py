# Choices and texts by substitutions: file content, defaults that are read only, names of nodes.
# starts: driver servo
# arguments: side:=right undeclared:=3
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import (
    AnonName,
    EqualsSubstitution,
    FileContent,
    IfElseSubstitution,
    LaunchConfiguration,
    NotEqualsSubstitution,
    OrSubstitution,
    PathJoinSubstitution,
    PythonExpression,
)
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

from launch import LaunchDescription


def generate_launch_description():
    side = LaunchConfiguration("side")
    number = LaunchConfiguration("undeclared", default="1")
    return LaunchDescription(
        [
            DeclareLaunchArgument("side", default_value="left"),
            Node(
                package="demo_arm",
                executable="driver",
                exec_name="driver",
                name=AnonName("driver"),
                parameters=[
                    {
                        "limits": FileContent(
                            PathJoinSubstitution(
                                [FindPackageShare("demo_arm"), "config", "limits.yaml"]
                            )
                        ),
                        "offset": IfElseSubstitution(
                            EqualsSubstitution(side, "left"), "0.5", "-0.5"
                        ),
                        "count": PythonExpression(["int(", number, ") + 1"]),
                    }
                ],
            ),
            Node(
                package="demo_arm",
                executable="servo",
                condition=IfCondition(
                    OrSubstitution(
                        NotEqualsSubstitution(side, "left"), EqualsSubstitution(number, 2)
                    )
                ),
            ),
        ]
    )
