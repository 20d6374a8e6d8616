"""Any robot without physics: its frames, and the page in the browser whose sliders move it."""

import os
from pathlib import Path

from launch_py import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    IncludeLaunchDescription,
    LaunchDescription,
)
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare
from launch_py.substitutions import Call, LaunchConfiguration, PathJoinSubstitution

FRONT = "front"


def describe(model: str, model_args: str, camera: str) -> str:
    """Return the URDF text of the model."""
    from arm_description.xacro_arguments import arguments_of_text
    from arm_description.xacro_expansion import expand_xacro

    # The default is left to the model: another one may take other values of that name.
    cameras = {} if camera == FRONT else {"camera": camera}
    return expand_xacro(model, cameras | arguments_of_text(model_args))


def own_folders(model: str) -> str:
    """Return where the page finds the meshes of a model that is not installed."""
    from arm_description.resources import folders_of

    return os.pathsep.join(map(str, folders_of(Path(model))))


def sliders(viewer: str) -> str:
    """Return whose sliders move the joints."""
    return "page" if viewer == "true" else "none"


def generate_launch_description() -> LaunchDescription:
    """Return the state publisher, what publishes joint states, the page and RViz."""
    share = FindPackageShare("arm_description")
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "model",
                default_value=PathJoinSubstitution([share, "urdf", "arm.urdf.xacro"]),
                description="URDF or xacro file",
            ),
            DeclareLaunchArgument(
                "model_args",
                default_value="",
                description='arguments of a xacro model: "a:=1 b:=2"',
            ),
            DeclareLaunchArgument(
                "camera",
                default_value=FRONT,
                description="the arm's camera",
                choices=[FRONT, "side", "none"],
            ),
            DeclareLaunchArgument(
                "viewer",
                default_value="true",
                description="open the page in the browser; false: joint_state_publisher instead",
                choices=["true", "false"],
            ),
            AppendEnvironmentVariable(
                "GZ_SIM_RESOURCE_PATH", Call(own_folders, LaunchConfiguration("model"))
            ),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(
                    PathJoinSubstitution([share, "launch", "robot_view.launch.py"])
                ),
                launch_arguments={
                    "robot_description": Call(
                        describe,
                        *map(LaunchConfiguration, ("model", "model_args", "camera")),
                    ),
                    "sliders": Call(sliders, LaunchConfiguration("viewer")),
                },
            ),
        ]
    )
