"""The myCobot's controllers, in a simulation that is up: one after the other, each when ready."""

from typing import Any

from launch_py import DeclareLaunchArgument, LaunchDescription, ProcessExited
from launch_py.conditions import IfCondition
from launch_py.ros import Node
from launch_py.substitutions import LaunchConfiguration


def spawner(controller: str, **options: Any) -> Node:
    """Return what starts a controller in the manager that the arguments name."""
    return Node(
        package="arm_control",
        executable="spawner",
        exec_name=f"spawner_{controller}",
        arguments=[controller, "--controller-manager", LaunchConfiguration("manager")],
        ready=ProcessExited(),
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
                description="the robot has its gripper",
            ),
            DeclareLaunchArgument(
                "use_sim_time",
                default_value="true",
                choices=["true", "false"],
                description="the nodes' clock is the simulation's",
            ),
            DeclareLaunchArgument(
                "manager",
                default_value="/controller_manager",
                description="the controller manager's node",
            ),
            broadcaster,
            arm,
            gripper,
        ]
    )
