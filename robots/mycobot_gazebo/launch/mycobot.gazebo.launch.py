"""The myCobot 280 in the simulation, with its controllers and its state publisher."""

import shutil

from launch_py import (
    Action,
    DeclareLaunchArgument,
    IncludeLaunchDescription,
    LaunchDescription,
    ReadyPanel,
    SetLaunchConfiguration,
)
from launch_py.actions import OpaqueFunction
from launch_py.conditions import IfCondition
from launch_py.errors import UsageError
from launch_py.launch_context import LaunchContext
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare, Node
from launch_py.substitutions import (
    AndSubstitution,
    EqualsSubstitution,
    LaunchConfiguration,
    PathJoinSubstitution,
)

SLIDERS = "joint_state_publisher_gui"
SWITCH = ["true", "false"]
POSE = ("x", "y", "z", "roll", "pitch", "yaw")
XACRO_ARGUMENTS = ("prefix", "use_gripper", "use_camera", "use_gazebo")
ARM_CONTROLLERS = "joint_state_broadcaster,arm_controller"
GRIPPER_CONTROLLER = "gripper_action_controller"

ARGUMENTS = {
    "robot_name": ("mycobot_280", "robot of mycobot_description", None),
    "prefix": ("", "prefix of every link and joint name", None),
    "use_gripper": ("true", "add the gripper", SWITCH),
    "use_camera": ("false", "add a depth camera on a stand, /camera_head/...", SWITCH),
    "load_controllers": ("true", "start the controllers with the simulation", SWITCH),
    "use_robot_state_pub": ("true", "publish the links' transforms on /tf", SWITCH),
    "jsp_gui": ("false", "show sliders, if no controller publishes joint states", SWITCH),
    "use_gazebo": ("true", "use the simulation as hardware", SWITCH),
    "use_sim_time": ("true", "nodes use simulation time", SWITCH),
    "world_file": ("pick_and_place_demo", "a shipped world, or a MuJoCo XML or SDF file", None),
    "real_time_factor": ("1.0", "simulation time over wall time; 0 is as fast as possible", None),
    "headless": ("true", "false opens a window", SWITCH),
    "record_run": ("", "file to record the run to, for `arm sim replay`", None),
    "viewer": ("false", "serve the browser page that shows and moves it", SWITCH),
    "planning": ("false", "start move_group, which plans motions for MoveIt's clients", SWITCH),
    "viewer_port": ("8080", "port of the page", None),
    "viewer_host": ("127.0.0.1", "address that the page listens on", None),
    "viewer_read_only": ("false", "let nobody do more than look at the page", SWITCH),
    "x": ("0.0", "x of base_link in the world, in m", None),
    "y": ("0.0", "y of base_link in the world, in m", None),
    "z": ("0.025", "z of base_link in m; the underside of the base is 0.025 m lower", None),
    "roll": ("0.0", "roll of base_link in rad", None),
    "pitch": ("0.0", "pitch of base_link in rad", None),
    "yaw": ("0.0", "yaw of base_link in rad", None),
    "copies": ("1", "copies on a square grid, in the namespaces mycobot_280_0, _1 and so on", None),
    "copy_spacing": ("1.0", "distance of neighbours on that grid, in m", None),
}


def choose_controllers(context: LaunchContext) -> list[Action]:
    """Return the setting with the controllers to start; sliders exclude a broadcaster.

    Raises:
        UsageError: both would publish the joint states.
    """
    words = context.launch_configurations
    loaded = words["load_controllers"] == "true"
    if loaded and words["jsp_gui"] == "true":
        raise UsageError(
            "jsp_gui:=true publishes /joint_states, and so does joint_state_broadcaster: "
            "add load_controllers:=false"
        )
    if not loaded:
        return [SetLaunchConfiguration("controllers_to_start", "")]
    gripper = f",{GRIPPER_CONTROLLER}" if words["use_gripper"] == "true" else ""
    return [SetLaunchConfiguration("controllers_to_start", f"{ARM_CONTROLLERS}{gripper}")]


def simulation() -> IncludeLaunchDescription:
    """Return sim.launch.py with this robot."""
    robot = LaunchConfiguration("robot_name")
    model_args = [part for name in XACRO_ARGUMENTS for part in argument(name)]
    places = [part for name in POSE for part in (LaunchConfiguration(name), ", ")][:-1]
    launch_file = PathJoinSubstitution([FindPackageShare("arm_gazebo"), "launch", "sim.launch.py"])
    return IncludeLaunchDescription(
        PythonLaunchDescriptionSource(launch_file),
        launch_arguments={
            "model": PathJoinSubstitution(
                [FindPackageShare("mycobot_description"), "urdf/robots", [robot, ".urdf.xacro"]]
            ),
            "model_args": model_args,
            "controllers": PathJoinSubstitution(
                [
                    *(FindPackageShare("mycobot_moveit_config"), "config", robot),
                    "ros2_controllers_template.yaml",
                ]
            ),
            "spawn": LaunchConfiguration("controllers_to_start"),
            "gz_args": ["-r -v 4 '", LaunchConfiguration("world_file"), "'"],
            "pose": ["[", *places, "]"],
        },
    )


def argument(name: str) -> list[str | LaunchConfiguration]:
    """Return a word for xacro that passes on one of this file's arguments."""
    return [f"'{name}:=", LaunchConfiguration(name), "' "]


def panel() -> ReadyPanel:
    """Return the panel shown to the user."""
    return ReadyPanel(
        title="The myCobot is up",
        topics=[
            (
                "/arm_controller/follow_joint_trajectory",
                "control_msgs/action/FollowJointTrajectory",
            ),
            ("/arm_controller/joint_trajectory", "trajectory_msgs/msg/JointTrajectory"),
            ("/gripper_action_controller/gripper_cmd", "control_msgs/action/GripperCommand"),
            ("/joint_states", "sensor_msgs/msg/JointState"),
        ],
        commands=[
            ("to and fro", "arm_gripper_loop_controller"),
            ("pick the cylinder up", "mycobot_pick_and_place"),
        ],
        condition=IfCondition(
            AndSubstitution(
                LaunchConfiguration("load_controllers"),
                EqualsSubstitution(LaunchConfiguration("copies"), "1"),
            )
        ),
    )


def generate_launch_description() -> LaunchDescription:
    """Return the simulation of the myCobot, and sliders where they are wanted."""
    rviz = "true" if shutil.which("rviz2") else "false"
    table = {
        **ARGUMENTS,
        "use_rviz": (rviz, "start RViz; where it is not installed, the page in its place", SWITCH),
    }
    sliders = Node(
        package=SLIDERS, executable=SLIDERS, condition=IfCondition(LaunchConfiguration("jsp_gui"))
    )
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=value, description=text, choices=choices)
                for name, (value, text, choices) in table.items()
            ),
            OpaqueFunction(function=choose_controllers),
            DeclareLaunchArgument(
                "moveit_config",
                default_value=PathJoinSubstitution(
                    [
                        *(FindPackageShare("mycobot_moveit_config"), "config"),
                        LaunchConfiguration("robot_name"),
                    ]
                ),
                description="folder of the MoveIt configuration that planning:=true takes",
            ),
            simulation(),
            sliders,
            panel(),
        ]
    )
