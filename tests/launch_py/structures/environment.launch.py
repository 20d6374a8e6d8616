# The environment of a camera or a licence: set, joined, kept and brought back.
# starts: driver servo
import os

from launch.actions import (
    PopEnvironment,
    PushEnvironment,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    UnsetEnvironmentVariable,
)
from launch.substitutions import EnvironmentVariable, LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription


def generate_launch_description():
    return LaunchDescription(
        [
            SetLaunchConfiguration(
                "home", EnvironmentVariable("HOME", default_value="/home/robot")
            ),
            PushEnvironment(),
            SetEnvironmentVariable(
                name="DRIVER_HOME", value=[LaunchConfiguration("home"), "/.driver"]
            ),
            SetEnvironmentVariable("LD_PRELOAD", ""),
            Node(
                package="demo_arm",
                executable="driver",
                additional_env={"RMW": os.environ.get("RMW_IMPLEMENTATION", "none")},
            ),
            PopEnvironment(),
            UnsetEnvironmentVariable(name="DISPLAY"),
            Node(package="demo_arm", executable="servo", cwd="/tmp"),
        ]
    )
