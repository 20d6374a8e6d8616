"""Start the myCobot's controllers in a running simulation, one after the other."""

from typing import Any

from launch_py import DeclareLaunchArgument, Finished, LaunchDescription
from launch_py.conditions import IfCondition
from launch_py.ros import Node
from launch_py.substitutions import LaunchConfiguration


def spawner(controller: str, **options: Any) -> Node:
    """Return the spawner of a controller for the manager that the arguments name."""
    return Node(
        package="arm_control",
        executable="spawner",
        exec_name=f"spawner_{controller}",
        arguments=[controller, "--controller-manager", LaunchConfiguration("manager")],
        ready=Finished(),
        **options,
    )


def generate_launch_description() -> LaunchDescription:
    """Return the spawners of the broadcaster, the arm and the gripper."""
    broadcaster = spawner("joint_state_broadcaster")
    arm = spawner("arm_controller", depends_on=broadcaster)
    gripper = spawner(
        "gripper_action_controller",
        depends_on=arm,
        condition=IfCondition(LaunchConfiguration("use_gripper")),
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "use_gripper",
                default_value="true",
                choices=["true", "false"],
                description="start the gripper's controller",
            ),
            DeclareLaunchArgument(
                "use_sim_time",
                default_value="true",
                choices=["true", "false"],
                description="nodes use simulation time",
            ),
            DeclareLaunchArgument(
                "manager",
                default_value="/controller_manager",
                description="name of the controller manager's node",
            ),
            broadcaster,
            arm,
            gripper,
        ]
    )
