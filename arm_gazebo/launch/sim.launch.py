"""Any robot in any world: the simulation with its controllers, and the state publisher."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from arm_gazebo.run.settings import RobotSettings, SimulationSettings
from arm_node.setting import settings_of
from launch_py import (
    Action,
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    Finished,
    IncludeLaunchDescription,
    LaunchDescription,
    LogInfo,
    Notified,
    ReadyPanel,
    SetLaunchConfiguration,
    Shutdown,
)
from launch_py.actions import OpaqueFunction
from launch_py.conditions import IfCondition
from launch_py.errors import NodeFileError, UsageError
from launch_py.launch_context import LaunchContext
from launch_py.launch_description_sources import PythonLaunchDescriptionSource
from launch_py.ros import FindPackageShare, Node
from launch_py.substitutions import LaunchConfiguration, PathJoinSubstitution

if TYPE_CHECKING:
    from arm_gazebo.launching.robot_setup import RobotSetup
    from arm_gazebo.launching.several_robots import PlacedRobot

MODEL_PATH = "GZ_SIM_RESOURCE_PATH"
"""The environment variable with Gazebo's model folders."""
SIMULATION = [each for each in settings_of(SimulationSettings) if each.launches]
PLACE = [each for each in settings_of(RobotSettings) if each.launches]
SWITCH = ["true", "false"]
MODEL: dict[str, tuple[Any, ...]] = {
    "model": ("", "URDF or xacro file"),
    "gz_args": ("", 'the same as Gazebo\'s options: "-r -v 4 objects.sdf"'),
    "resource_path": (
        "",
        "folders for model://, separated by colons, before GZ_SIM_RESOURCE_PATH",
    ),
}
ROBOT: dict[str, tuple[Any, ...]] = {
    "model_args": ("", 'arguments of a xacro model: "a:=1 b:=2"'),
    "controllers": (
        "",
        "parameter file of the controller manager and its controllers, where ${name} or "
        "$(var name) is an argument of the model; by default a position controller, with "
        "planning:=true a trajectory controller",
    ),
    "spawn": (
        "auto",
        "controllers to start with the simulation, separated by commas; auto starts those whose "
        "joints are not claimed yet, in the file's order, and leaves out those that cannot start",
    ),
    "namespace": ("", "namespace of all nodes of the robot"),
}
SEVERAL: dict[str, tuple[Any, ...]] = {
    "robots": (
        "",
        "YAML file of several robots in one world, instead of a model: NAMESPACE: "
        "{model: FILE, and model_args, controllers, spawn, package_path, base, pose, prefix}",
    ),
    "copies": (
        "1",
        "copies of the robot in one world, on a square grid, each in a namespace of its own: the "
        "robot's name, or `namespace`, with _0, _1 and so on",
    ),
    "copy_spacing": ("1.0", "distance of neighbours on that grid, in m; the first is at `pose`"),
}
HARDWARE: dict[str, tuple[Any, ...]] = {
    "hardware": (
        "simulation",
        "what the controllers drive: simulation, mock, feetech, mycobot_280, or a plugin, such as "
        "my_package/MyServos",
    ),
    "port": ("", "serial port of a real arm, such as /dev/ttyUSB0"),
    "calibration": ("", "calibration file of a real arm, by `arm calibrate` or LeRobot"),
    "hardware_args": ("", 'other <param>s of the hardware plugin: "a:=1 b:=2"'),
}
NODES: dict[str, tuple[Any, ...]] = {
    "log_level": ("info", "log level of the simulation", ["info", "warn", "error", "fatal"]),
    "use_sim_time": ("true", "the state publisher uses simulation time", SWITCH),
    "use_robot_state_pub": ("true", "publish the links' transforms on /tf", SWITCH),
    "planning": ("false", "start move_group, which plans motions for MoveIt's clients", SWITCH),
    "viewer": ("false", "serve the browser page that shows and moves it", SWITCH),
    "use_rviz": (
        "false",
        "start RViz; the browser page replaces it if it is not installed",
        SWITCH,
    ),
    "rviz_config_file": (
        PathJoinSubstitution([FindPackageShare("arm_description"), "config", "rviz", "arm.rviz"]),
        "what RViz shows",
    ),
}


def declared(table: Mapping[str, tuple[Any, ...]]) -> list[DeclareLaunchArgument]:
    """Return the declarations of arguments: of each its default, description and any choices."""
    return [
        DeclareLaunchArgument(
            name,
            default_value=default,
            description=text,
            choices=choices[0] if choices else None,
        )
        for name, (default, text, *choices) in table.items()
    ]


def included(package: str, name: str, **options: Any) -> IncludeLaunchDescription:
    """Return the launch file of that name of a package."""
    path = PathJoinSubstitution([FindPackageShare(package), "launch", name])
    return IncludeLaunchDescription(PythonLaunchDescriptionSource(path), **options)


@contextmanager
def usage_errors() -> Iterator[None]:
    """Turn errors of the packages about arguments into usage errors without a traceback."""
    from arm_description.errors import DescriptionError
    from arm_gazebo.errors import ControllerTypeError, GazeboError

    try:
        yield
    except ControllerTypeError as error:
        raise NodeFileError(str(error)) from error
    except (DescriptionError, GazeboError) as error:
        raise UsageError(str(error)) from error


def take_gz_args(context: LaunchContext) -> None:
    """Set the arguments of this file that the user has not given from Gazebo's options."""
    from arm_gazebo.launching.gz_arguments import launch_arguments

    with usage_errors():
        given = launch_arguments(context.launch_configurations["gz_args"])
    for name, value in given.items():
        context.launch_configurations.setdefault(name, value)


def simulate(context: LaunchContext) -> list[Action]:
    """Return the nodes of a robot, or of several, and messages about added defaults."""
    with usage_errors():
        return nodes(context.launch_configurations)


def nodes(words: Mapping[str, str]) -> list[Action]:
    """Check the arguments before anything starts, and return the nodes."""
    # Imported here, so that --show-args needs only this file.
    from arm_gazebo.launching.world_path import find_world
    from arm_gazebo.window.display import check_display

    if words["headless"] == "false":
        check_display()
    if words.get("servo") == "true" and words["planning"] == "false":
        raise UsageError("servo:=true needs planning:=true")
    find_world(words["world"])  # The simulation would say so, too, but among what has started.
    several = words["robots"] or words["copies"] != "1"
    if words["hardware"] != "simulation" and (several or words["record_run"]):
        raise UsageError(
            "hardware:= drives one real arm: leave out robots:=, copies:= and record_run:=; "
            "`arm bag record` records it"
        )
    if several:
        if words["planning"] == "true":
            raise UsageError("planning:=true plans for one robot; leave out robots:= and copies:=")
        robots = robots_of(words)
        panel = [] if words["robots"] else [panel_of(list(robots))]
        return [*simulate_several(robots), *panel]
    setup = single_robot(words)
    if words["hardware"] != "simulation":
        return real_robot(words, setup)
    if words["planning"] == "true" and not words.get("moveit_config"):
        setup = free_at_start(setup)
    place = {name: LaunchConfiguration(name) for name in ("base", "pose")}
    return [
        *(LogInfo(msg=remark) for remark in setup.remarks),
        *left_out({"": setup.left_out}),
        simulation({**setup.parameters(), **place}, [setup.controllers], words["namespace"]),
        state_publisher(publisher_parameters(setup.description), words["namespace"]),
        SetLaunchConfiguration("planning_description", setup.description),
    ]


def single_robot(words: Mapping[str, str]) -> "RobotSetup":
    """Return the robot that the argument `model` names."""
    from arm_gazebo.launching.default_control import COMMANDER, TRAJECTORY
    from arm_gazebo.launching.robot_setup import set_up_robot

    if not words["model"]:
        raise UsageError("launch argument 'model' (URDF or xacro file) is empty: give model:=FILE")
    names = ("model", "model_args", "controllers", "spawn", "package_path")
    commander = TRAJECTORY if words["planning"] == "true" else COMMANDER
    return set_up_robot(*(words[name] for name in names), commander=commander)


def free_at_start(setup: "RobotSetup") -> "RobotSetup":
    """Return a robot without an SRDF so that motions can be planned from where it starts."""
    from arm_gazebo.launching.free_start import starting_free

    return starting_free(setup)


def robots_of(words: Mapping[str, str]) -> "Mapping[str, PlacedRobot]":
    """Return the robots that a file lists, or copies of one, by namespace."""
    from arm_gazebo.launching.several_robots import (
        copies_of,
        read_copies,
        read_grid,
        robots_of_file,
    )
    from arm_gazebo.robot.collision_policy import MAX_LAYERS

    count = read_copies(words["copies"], MAX_LAYERS)
    if not words["robots"]:
        grid = read_grid(count, words["copy_spacing"], words["pose"])
        return copies_of(single_robot(words), grid, words["base"], words["namespace"])
    if count > 1:
        raise UsageError("copies:= repeats one model, and robots:=FILE lists several: give one")
    return robots_of_file(words["robots"])


def simulate_several(robots: "Mapping[str, PlacedRobot]") -> list[Action]:
    """Return the nodes of robots in one world, by namespace."""
    from arm_gazebo.launching.controllers_file import controllers_in_namespace
    from arm_gazebo.launching.edited_description import placed

    settings: dict[str, Any] = {"robots": list(robots)}
    controllers, remarks, descriptions = [], [], {}
    for name, robot in robots.items():
        setup = robot.setup
        if robot.base == "fixed":
            setup = replace(setup, description=placed(setup.description, robot.pose))
        controllers.append(controllers_in_namespace(name, setup.controllers))
        settings[name] = replace(robot, setup=setup).parameters()
        descriptions[name] = setup.description
        remarks += [LogInfo(msg=f"{name}: {remark}") for remark in setup.remarks]
    missing = left_out({f"{name}: ": robot.setup.left_out for name, robot in robots.items()})
    return [simulation(settings, controllers), *remarks, *missing, state_publishers(descriptions)]


def real_robot(words: Mapping[str, str], setup: "RobotSetup") -> list[Action]:
    """Return the nodes of a robot on other hardware, at the time of the system."""
    from arm_description.xacro.expansion import arguments_of_text
    from arm_gazebo.launching.real_hardware import on_hardware

    given = {name: words[name] for name in ("port", "calibration") if words[name]}
    parameters = {**given, **arguments_of_text(words["hardware_args"])}
    description = on_hardware(setup.description, words["hardware"], parameters)
    manager = Node(
        package="arm_control",
        executable="ros2_control_node",
        namespace=words["namespace"],
        parameters=[setup.controllers],
        ros_arguments=["--log-level", LaunchConfiguration("log_level")],
        ready=Notified(),
        on_exit=Shutdown(),
    )
    spawner = Node(
        package="arm_control",
        executable="spawner",
        namespace=words["namespace"],
        arguments=list(setup.spawn),
        ready=Finished(),
        depends_on=manager,
    )
    return [
        SetLaunchConfiguration("use_sim_time", "false"),
        *(LogInfo(msg=remark) for remark in setup.remarks),
        *left_out({"": setup.left_out}),
        state_publisher(publisher_parameters(description), words["namespace"]),
        manager,
        *([spawner] if setup.spawn else []),
        SetLaunchConfiguration("planning_description", description),
    ]


def left_out(sentences: Mapping[str, str]) -> list[Action]:
    """Return warnings about controllers that the suite does not have, shown when all is ready."""
    rows = [("warning", f"{whose}{sentence}") for whose, sentence in sentences.items() if sentence]
    return [ReadyPanel(notes=rows)] if rows else []


def panel_of(names: list[str]) -> ReadyPanel:
    """Return the panel that tells the user what the copies are called."""
    first, last = names[0], names[-1]
    return ReadyPanel(
        title=f"{len(names)} robots are up, from /{first} to /{last}",
        topics=[
            (f"/{first}/joint_states", "sensor_msgs/msg/JointState; likewise for the others"),
            ("/tf", f"links have the prefix {first}_ and so on"),
        ],
        commands=[
            ("its controllers", f"arm control list_controllers -c /{first}/controller_manager"),
        ],
    )


def simulation(settings: dict[str, Any], controllers: list[Any], namespace: str = "") -> Node:
    """Return the simulation node; `settings` are parameters that are not launch arguments."""
    every = {**settings, **{each.name: LaunchConfiguration(each.name) for each in SIMULATION}}
    return Node(
        package="arm_gazebo",
        executable="arm_gazebo_node",
        namespace=namespace,
        parameters=[*controllers, {"arm_gazebo": {"ros__parameters": every}}],
        ros_arguments=["--log-level", LaunchConfiguration("log_level")],
        ready=Notified(),
        on_exit=Shutdown(),
    )


def publisher_parameters(description: str) -> dict[str, Any]:
    """Return the parameters of a robot's state publisher."""
    use_sim_time = LaunchConfiguration("use_sim_time")
    return {"robot_description": description, "use_sim_time": use_sim_time}


def state_publishers(descriptions: Mapping[str, str]) -> Node:
    """Return one process for all robots, by namespace; one for each costs 110 MB and 3 % of a core.

    The nodes' names are those of separate processes.
    """
    nodes = {
        f"/{name}/robot_state_publisher": {"ros__parameters": publisher_parameters(description)}
        for name, description in descriptions.items()
    }
    return state_publisher(nodes, arguments=["--namespaces", *descriptions])


def state_publisher(
    parameters: dict[str, Any], namespace: str = "", arguments: Sequence[str] = ()
) -> Node:
    """Return the process that publishes the transforms of links."""
    return Node(
        package="arm_description",
        executable="robot_state_publisher",
        namespace=namespace,
        exec_name=f"{namespace}_state_publisher" if namespace else None,
        parameters=[parameters],
        arguments=arguments,
        ready=Notified(),
        condition=IfCondition(LaunchConfiguration("use_robot_state_pub")),
    )


def generate_launch_description() -> LaunchDescription:
    """Return the simulation and the state publisher."""
    return LaunchDescription(
        [
            *declared(MODEL),
            OpaqueFunction(function=take_gz_args),
            AppendEnvironmentVariable(
                MODEL_PATH, LaunchConfiguration("resource_path"), prepend=True
            ),
            *declared(ROBOT),
            *(DeclareLaunchArgument(each.name, **each.launch_argument) for each in PLACE),
            *declared(SEVERAL),
            *(DeclareLaunchArgument(each.name, **each.launch_argument) for each in SIMULATION),
            *declared(HARDWARE),
            *declared(NODES),
            OpaqueFunction(function=simulate),
            included(
                "arm_planning",
                "move_group.launch.py",
                condition=IfCondition(LaunchConfiguration("planning")),
            ),
            included(
                "arm_viewer",
                "viewer.launch.py",
                condition=IfCondition(LaunchConfiguration("viewer")),
            ),
            included(
                "arm_viewer",
                "rviz.launch.py",
                launch_arguments={"page_is_open": LaunchConfiguration("viewer")},
            ),
        ]
    )
