"""The world with the arm in it: the simulation and the state publisher, no controllers.

The joints hold their position; `hold_joints:=false` lets the arm fall, as it does in Gazebo
before any controller is there.
"""

from launch_py import (
    DeclareLaunchArgument,
    LaunchDescription,
    Notified,
    SetLaunchConfiguration,
    Shutdown,
)
from launch_py.ros import FindPackageShare, Node, ParameterValue
from launch_py.substitutions import Call, LaunchConfiguration, PathJoinSubstitution

DESCRIPTION_ARGUMENTS = {
    "j0_pos": ("0.0", "where j0 starts, in rad"),
    "j1_pos": ("0.0", "where j1 starts, in rad"),
    "j2_pos": ("0.0", "where j2 starts, in rad"),
    "j3_pos": ("0.0", "where j3 starts, in rad"),
    "base": ("fixed", "bolted to the floor, or standing free on its foot", ["fixed", "free"]),
    "camera": (
        "front",
        "on the foot looking forward, or 0.75 m away looking at the arm",
        ["front", "side", "none"],
    ),
    "camera_profile": (
        "standard",
        "320x240, or 800x800 with noise and also on /camera/image_raw",
        ["standard", "large"],
    ),
    "velocity_limit": ("2.0", "of every joint, in rad/s; 0.1 gives the original arm's"),
    "effort_limit": ("5.0", "of every joint, in N m; 300 gives the original arm's"),
    "j1_limit": ("3.14", "of j1 to both sides, in rad"),
    "prefix": ("", "put before the names of links and joints"),
}

SIMULATION_ARGUMENTS = {
    "world": ("empty", "a shipped world (empty, objects), or a MuJoCo XML file"),
    "real_time_factor": ("1.0", "simulated over wall time; 0 is as fast as possible"),
    "physics_step": ("0.0", "in s; 0 chooses one of at most 2 ms that fits the control rate"),
    "hold_joints": ("true", "joints that no controller claims hold their position"),
    "self_collide": ("false", "links of the robot touch each other"),
    "strict": ("false", "a missing mesh is an error, not a box and a warning"),
    "package_path": ("", "folders for package:// besides the installed packages, with commas"),
    "render_backend": ("auto", "of the cameras", ["auto", "egl", "osmesa", "raycast"]),
    "spawn": ("", "controllers to start with the simulation, with commas"),
}


def describe(model: str, **arguments: str) -> str:
    """Return the URDF text of the model."""
    # Here, so that --show-args needs nothing but this file.
    from arm_description.xacro_expansion import expand_xacro

    return expand_xacro(model, arguments)


def declared(arguments: dict) -> list[DeclareLaunchArgument]:
    """Return the declarations of a table of arguments."""
    return [
        DeclareLaunchArgument(
            name,
            default_value=default,
            description=description,
            choices=choices[0] if choices else None,
        )
        for name, (default, description, *choices) in arguments.items()
    ]


def generate_launch_description() -> LaunchDescription:
    """Return the simulation and the state publisher."""
    model = PathJoinSubstitution([FindPackageShare("arm_description"), "urdf", "arm.urdf.xacro"])
    controllers = PathJoinSubstitution(
        [FindPackageShare("arm_control"), "config", "arm_control.yaml"]
    )
    description = ParameterValue(LaunchConfiguration("robot_description"), value_type=str)
    simulation = Node(
        package="arm_gazebo",
        executable="arm_gazebo_node",
        parameters=[
            LaunchConfiguration("controllers"),
            {
                "robot_description": description,
                "base": LaunchConfiguration("base"),
                **{name: LaunchConfiguration(name) for name in SIMULATION_ARGUMENTS},
            },
        ],
        parameters_node="arm_gazebo",
        ready=Notified(),
        on_exit=Shutdown(),
    )
    state_publisher = Node(
        package="arm_description",
        executable="robot_state_publisher",
        parameters=[{"robot_description": description, "use_sim_time": True}],
        ready=Notified(),
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument("model", default_value=model, description="URDF or xacro file"),
            DeclareLaunchArgument(
                "controllers",
                default_value=controllers,
                description="parameter file of the controller manager and its controllers",
            ),
            *declared(DESCRIPTION_ARGUMENTS),
            *declared(SIMULATION_ARGUMENTS),
            SetLaunchConfiguration(
                "robot_description",
                Call(
                    describe,
                    LaunchConfiguration("model"),
                    **{name: LaunchConfiguration(name) for name in DESCRIPTION_ARGUMENTS},
                ),
            ),
            simulation,
            state_publisher,
        ]
    )
