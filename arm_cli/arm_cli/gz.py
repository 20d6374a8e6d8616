"""`arm gz`: Gazebo's commands for this simulation, with the output format of Gazebo."""

import argparse
import math
import shlex
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from arm_cli.arguments import Argument, Flag, verb
from arm_cli.errors import ArmCliError, CommandUsageError, NoSuchNameError, StoppedError
from arm_cli.output import say, say_document
from arm_cli.sim.simulation import SimulationClient, ask_simulation
from arm_node.names import describe_known
from arm_node.rigid_transform import RigidTransform

if TYPE_CHECKING:
    from arm_cli.ros.listeners import ClockListener
    from arm_cli.ros.session import CommandSession

Fields = Mapping[str, Any]
"""Values by field name: numbers, texts, nested fields, or lists. Zero and "" are not printed."""


def text_of(fields: Fields) -> str:
    """Return the text format of a message, with a newline after each line."""
    return "".join(f"{line}\n" for line in _lines(fields))


def _lines(fields: Fields) -> Iterator[str]:
    for name, value in fields.items():
        for item in value if isinstance(value, list) else [value]:
            if isinstance(item, Mapping):
                yield f"{name} {{"
                yield from (f"  {line}" for line in _lines(item))
                yield "}"
            elif isinstance(item, str):
                if item:
                    yield f'{name}: "{item}"'
            elif item:
                yield f"{name}: {item:.17g}" if isinstance(item, float) else f"{name}: {item}"


def time_of(seconds: float) -> Fields:
    """Return the fields of a gz.msgs.Time."""
    whole = int(seconds)
    return {"sec": whole, "nsec": round((seconds - whole) * 1e9)}


def pose_of(name: str, number: int, pose: Any) -> Fields:
    """Return the fields of a gz.msgs.Pose of an entity, from its geometry_msgs/msg/Pose."""
    p, q = pose.position, pose.orientation
    return {
        "name": name,
        "id": number,
        "position": {"x": p.x, "y": p.y, "z": p.z},
        "orientation": {"x": q.x, "y": q.y, "z": q.z, "w": q.w},
    }


CLOCK, STATS, POSES = "gz.msgs.Clock", "gz.msgs.WorldStatistics", "gz.msgs.Pose_V"
PERIOD_S = 0.2
"""The period of poses and statistics, five times a second as in Gazebo."""

SENSORS = {
    "sensor_msgs/msg/CameraInfo": "gz.msgs.CameraInfo",
    "sensor_msgs/msg/Image": "gz.msgs.Image",
    "sensor_msgs/msg/Imu": "gz.msgs.IMU",
    "sensor_msgs/msg/LaserScan": "gz.msgs.LaserScan",
    "sensor_msgs/msg/PointCloud2": "gz.msgs.PointCloudPacked",
    "geometry_msgs/msg/WrenchStamped": "gz.msgs.Wrench",
}
"""Gazebo's message types of sensors, by the type in ROS."""


@verb(
    Flag("-l", "--list", help="list all topics"),
    Flag("-i", "--info", help="show a topic's publishers"),
    Flag("-e", "--echo", help="print a topic's messages"),
    Argument("-t", "--topic", metavar="NAME", help="the topic for -i and -e"),
    Argument("-n", "--num", type=int, metavar="N", help="end after N messages"),
    Argument("-d", "--duration", type=float, metavar="S", help="end after that time"),
)
def topic(options: argparse.Namespace) -> None:
    """List topics, show a topic's publishers, or print its messages."""
    if not (options.list or options.info or options.echo):
        raise CommandUsageError("give -l, -i -t NAME or -e -t NAME")
    if not options.list and not options.topic:
        raise CommandUsageError("which topic? Give -t NAME")
    with ask_simulation() as simulation:
        topics = known_topics(simulation)
        if options.list:
            say(*sorted(topics))
            return
        name = options.topic
        if name not in topics:
            raise NoSuchNameError(f"no Gazebo topic {name!r}; {describe_known(name, topics)}")
        if options.info:
            say(
                "Publishers [Address, Message Type]:",
                f"  shared memory and UDP of ROS, {topics[name]}",
            )
            say("No subscribers on topic [" + name + "]")
            return
        echo(simulation, name, topics[name], options)


def known_topics(simulation: SimulationClient) -> dict[str, str]:
    """Return the types of Gazebo's topics for which this simulation has data, by name."""
    from arm_cli.ros.graph import Graph

    world = world_name(simulation)
    graph = Graph(simulation.session)
    graph.settle()
    found = {
        topic: SENSORS[types[0]] for topic, types in graph.topics().items() if types[0] in SENSORS
    }
    place = f"/world/{world}"
    return {
        **found,
        "/clock": CLOCK,
        "/stats": STATS,
        f"{place}/clock": CLOCK,
        f"{place}/dynamic_pose/info": POSES,
        f"{place}/pose/info": POSES,
        f"{place}/stats": STATS,
    }


def world_name(simulation: SimulationClient) -> str:
    """Return the name of the world, or "default" if it has none, as in Gazebo."""
    with suppress(ArmCliError):
        return str(simulation.ask("GetCurrentWorld", "get_current_world").world.name) or "default"
    return "default"


def echo(simulation: SimulationClient, name: str, kind: str, options: argparse.Namespace) -> None:
    """Print messages until the count or the duration is reached, or a signal arrives."""
    if kind in SENSORS.values():
        raise CommandUsageError(f"{name} is a ROS topic: use arm topic echo {name}")
    session = simulation.session
    end_s = session.clock_s() + options.duration if options.duration else math.inf
    with suppress(StoppedError):
        found = messages(simulation, kind, lambda: session.clock_s() >= end_s)
        for number, fields in enumerate(found, 1):
            say_document(text_of(fields))
            if options.num and number >= options.num:
                return


def messages(
    simulation: SimulationClient, kind: str, is_over: Callable[[], bool]
) -> Iterator[Fields]:
    """Yield the messages of a type until `is_over()`, even if simulation time stands still."""
    from arm_cli.ros.listeners import ClockListener

    session = simulation.session
    clock = ClockListener(session)
    session.wait_until(lambda: clock.has_begun or is_over(), lambda: "waiting for /clock")
    while not is_over():
        if kind == POSES:
            found = simulation.ask("GetEntitiesStates", "get_entities_states")
            poses = enumerate(zip(found.entities, found.states, strict=True), 1)
            yield {
                "header": {"stamp": time_of(clock.now_s)},
                "pose": [pose_of(name, number, state.pose) for number, (name, state) in poses],
            }
            session.spin_for(PERIOD_S)
        elif kind == STATS:
            session.spin_for(PERIOD_S)
            factor = clock.simulated_s / clock.wall_s if clock.wall_s else 0.0
            yield {"sim_time": time_of(clock.now_s), "real_time_factor": factor}
        else:
            yield {"sim": time_of(clock.now_s)}
            _wait_for_tick(session, clock, is_over)


def _wait_for_tick(
    session: "CommandSession", clock: "ClockListener", is_over: Callable[[], bool]
) -> None:
    last_s = clock.now_s
    session.wait_until(lambda: clock.now_s != last_s or is_over())


SERVICES = {
    "control": "`arm sim pause`, `play`, `step` and `reset`",
    "create": "`arm sim spawn FILE --name NAME`",
    "remove": "`arm sim delete NAME`",
    "set_pose": "the ROS service /set_entity_state",
    "state": "`arm sim info`",
}
"""Gazebo's services below /world/NAME, and what to use instead here."""


@verb(
    Flag("--list", help="list the models"),
    Argument("-m", "--model", metavar="NAME", help="the model to show"),
    Flag("-p", "--pose", help="show its pose (always on)"),
)
def model(options: argparse.Namespace) -> None:
    """List the models, or print the pose of one."""
    if not (options.list or options.model):
        raise CommandUsageError("give --list, or -m NAME")
    with ask_simulation() as simulation:
        world = world_name(simulation)
        found = simulation.ask("GetEntitiesStates", "get_entities_states")
    say(f"Requesting state for world [{world}]...", "")
    if options.list:
        say("Available models:", *(f"    - {name}" for name in found.entities))
        return
    if options.model not in found.entities:
        known = describe_known(options.model, found.entities, "there is")
        raise NoSuchNameError(f"no model named <{options.model}>; {known}")
    number = list(found.entities).index(options.model)
    say(*pose_lines(options.model, number + 1, found.states[number].pose))


def pose_lines(name: str, number: int, pose: Any) -> list[str]:
    """Return the lines that gz prints for a model's pose, a geometry_msgs/msg/Pose."""
    p, q = pose.position, pose.orientation
    roll, pitch, yaw = RigidTransform(rotation=(q.x, q.y, q.z, q.w)).rpy()
    return [
        f"Model: [{number}]",
        f"  - Name: {name}",
        "  - Pose [ XYZ (m) ] [ RPY (rad) ]:",
        f"      [{p.x:.6f} {p.y:.6f} {p.z:.6f}]",
        f"      [{roll:.6f} {pitch:.6f} {yaw:.6f}]",
    ]


@verb(
    Flag("-l", "--list", help="list all services"),
    Flag("-i", "--info", help="show what to use instead here"),
    Argument("-s", "--service", metavar="NAME", help="the service"),
    *(
        Argument(name, metavar="TEXT", help="accepted; services cannot be called here")
        for name in ("--reqtype", "--reptype", "--timeout", "--req")
    ),
)
def service(options: argparse.Namespace) -> None:
    """List the services, or print what to use instead of one."""
    if not (options.list or options.service):
        raise CommandUsageError("give -l, or -s NAME")
    with ask_simulation() as simulation:
        place = f"/world/{world_name(simulation)}"
    known = {f"{place}/{name}": instead for name, instead in SERVICES.items()}
    if options.list:
        say(*sorted(known))
        return
    if options.service not in known:
        hint = describe_known(options.service, known)
        raise NoSuchNameError(f"no service {options.service!r}; {hint}")
    sentence = f"instead of {options.service} use {known[options.service]}"
    if not options.info:
        raise CommandUsageError(sentence)
    say(sentence)


SERVER = "-s"
HELP = """usage: arm gz sim [-r] [-s] [-v LEVEL] [FILE]

Show a world: empty, shapes, objects, pick, pick_and_place_demo, pick_demonstrations, house, or an
SDF file. The options are Gazebo's. The page opens in the browser unless -s is given. The world runs
at once, even without -r.
"""


def sim(words: Sequence[str]) -> int:
    """Launch the world; return the exit code."""
    if any(word in ("-h", "--help") for word in words):
        say_document(HELP, end="")
        return 0
    given = [word for word in words if ":=" not in word]
    arguments = [word for word in words if ":=" in word]
    if "-r" not in given:
        given.insert(0, "-r")
    page = "false" if SERVER in given else "true"
    file = ("ros_gz_sim", "gz_sim.launch.py")
    # Imported here, because the other verbs do without it.
    from arm_cli.launch import launch

    return launch([*file, f"gz_args:={shlex.join(given)}", f"viewer:={page}", *arguments])
