# An OpaqueFunction that makes a group for each robot that an argument lists.
# starts: driver driver-2 driver-3
# arguments: robots:=a,b,c
from launch.actions import DeclareLaunchArgument, GroupAction, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushROSNamespace

from launch import LaunchDescription


def robots(context, *args, **kwargs):
    names = LaunchConfiguration("robots").perform(context).split(",")
    return [
        GroupAction(
            [
                PushROSNamespace(name),
                Node(
                    package="demo_arm", executable="driver", parameters=[{"pose": [float(i), 0.0]}]
                ),
            ]
        )
        for i, name in enumerate(names)
    ]


def generate_launch_description():
    return LaunchDescription(
        [
            DeclareLaunchArgument("robots", default_value="a"),
            OpaqueFunction(function=robots, args=["unused"]),
        ]
    )
