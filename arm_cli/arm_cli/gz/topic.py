"""`arm gz topic`: Gazebo's topics, as far as this simulation has their data."""

import argparse
import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import TYPE_CHECKING

from arm_cli.arguments import Argument, Flag, verb
from arm_cli.errors import ArmCliError, CommandUsageError, NoSuchNameError, StoppedError
from arm_cli.gz.protobuf_text import Fields, pose_of, text_of, time_of
from arm_cli.output import say, say_document
from arm_cli.sim.simulation import SimulationClient, ask_simulation
from arm_node.names import describe_known

if TYPE_CHECKING:
    from arm_cli.ros.clock_listener import ClockListener
    from arm_cli.ros.session import CommandSession

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
def run(options: argparse.Namespace) -> None:
    """List topics, show a topic's publishers, or print its messages.

    Raises:
        CommandUsageError: none of -l, -i, -e is given, or a topic is missing.
        NoSuchNameError: there is no such topic.
        UnansweredError: no simulation answers.
    """
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
    from arm_cli.ros.clock_listener import ClockListener

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
