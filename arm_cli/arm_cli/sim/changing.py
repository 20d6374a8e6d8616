"""The verbs of `arm sim` that change a running simulation: its world, its state and its time."""

import argparse
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from arm_cli.arguments import Argument, Exclusive, Flag, positive_number, verb
from arm_cli.errors import CommandUsageError, SimulationRefusedError
from arm_cli.output import say
from arm_cli.sim.simulation import NAMESPACE, PAUSED, PLAYING, ask_simulation

if TYPE_CHECKING:
    from geometry_msgs.msg import Pose

    from arm_cli.sim.simulation import SimulationClient

SCOPE_TIME, SCOPE_STATE, SCOPE_SPAWNED, SCOPE_ALL = 1, 2, 4, 255


@verb(
    Argument("file", help="URDF, xacro, SDF or MJCF: a path or a URI such as model://can"),
    Argument("--name", default="", help="name of the entity; default: its body's name"),
    Argument(
        "--pose",
        nargs=6,
        type=float,
        default=[0.0] * 6,
        metavar=("X", "Y", "Z", "ROLL", "PITCH", "YAW"),
        help="pose in m and rad (default: the origin)",
    ),
    Argument(
        "--frame", default="", help="frame of the pose: an entity or a link (default: the world)"
    ),
    NAMESPACE,
)
def spawn(options: argparse.Namespace) -> None:
    """Spawn the entity and print its name."""
    with ask_simulation(options.namespace) as simulation:
        from geometry_msgs.msg import PoseStamped
        from simulation_interfaces.msg import Resource

        x, y, z, *rpy = options.pose
        pose = PoseStamped(pose=_pose(x, y, z, rpy))
        pose.header.frame_id = options.frame
        # A relative path is relative to this process, not to the simulation's working folder.
        uri = options.file if "://" in options.file else str(Path(options.file).absolute())
        answer = simulation.ask(
            "SpawnEntity",
            "spawn_entity",
            name=options.name,
            allow_renaming=not options.name,
            entity_resource=Resource(uri=uri),
            initial_pose=pose,
        )
    say(answer.entity_name)


@verb(
    Argument("entities", nargs="+", metavar="ENTITY", help="names, as listed by arm sim info"),
    NAMESPACE,
)
def delete(options: argparse.Namespace) -> None:
    """Delete the entities, one after another."""
    with ask_simulation(options.namespace) as simulation:
        for entity in options.entities:
            simulation.ask("DeleteEntity", "delete_entity", entity=entity)


@verb(
    Argument("entity", metavar="ENTITY", help="name, as listed by arm sim info"),
    *(Argument(axis, metavar=axis.upper(), type=float, help="in m") for axis in "xyz"),
    Argument(
        "rpy",
        nargs="*",
        type=float,
        metavar="ROLL PITCH YAW",
        help="in rad (default: as it is turned now)",
    ),
    NAMESPACE,
)
def move(options: argparse.Namespace) -> None:
    """Move an entity, which is at rest afterwards."""
    if len(options.rpy) not in (0, 3):
        raise CommandUsageError("a pose is X Y Z, or X Y Z ROLL PITCH YAW")
    with ask_simulation(options.namespace) as simulation:
        found = simulation.ask("GetEntityState", "get_entity_state", entity=options.entity)
        pose = _pose(options.x, options.y, options.z, options.rpy or [0.0] * 3)
        if not options.rpy:
            pose.orientation = found.state.pose.orientation
        found.state.pose = pose
        simulation.ask(
            "SetEntityState",
            "set_entity_state",
            entity=options.entity,
            state=found.state,
            set_pose=True,
        )


def _pose(x: float, y: float, z: float, rpy: Sequence[float]) -> "Pose":
    from geometry_msgs.msg import Point, Pose, Quaternion

    from arm_description.transforms import quaternion_from_rpy

    qx, qy, qz, qw = quaternion_from_rpy(rpy).tolist()
    return Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw))


@verb(NAMESPACE)
def pause(options: argparse.Namespace) -> None:
    """Pause the simulation."""
    with ask_simulation(options.namespace) as simulation:
        simulation.set_state(PAUSED)


@verb(NAMESPACE)
def play(options: argparse.Namespace) -> None:
    """Resume the simulation."""
    with ask_simulation(options.namespace) as simulation:
        simulation.set_state(PLAYING)


@verb(
    Flag("--keep-spawned", help="keep spawned entities, and deletions"),
    Flag("--keep-clock", help="keep the clock running"),
    NAMESPACE,
)
def reset(options: argparse.Namespace) -> None:
    """Return everything to its start, apart from what the options keep."""
    scope = SCOPE_ALL
    if options.keep_spawned or options.keep_clock:
        scope = SCOPE_STATE
        scope |= 0 if options.keep_spawned else SCOPE_SPAWNED
        scope |= 0 if options.keep_clock else SCOPE_TIME
    with ask_simulation(options.namespace) as simulation:
        simulation.ask("ResetSimulation", "reset_simulation", scope=scope)


PARAMETER = "real_time_factor"


def _factor(text: str) -> float:
    try:
        factor = float(text)
    except ValueError:
        factor = math.nan
    if not 0.0 <= factor < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is not a finite number of at least 0")
    return factor


@verb(
    Argument(
        "factor",
        nargs="?",
        type=_factor,
        help="simulated seconds per second; 0 is as fast as possible (default: print it)",
    ),
    NAMESPACE,
)
def speed(options: argparse.Namespace) -> None:
    """Set the factor, or print it."""
    with ask_simulation(options.namespace, must_run=options.factor is None) as simulation:
        if options.factor is None:
            from arm_cli.ros.parameters import content_of

            say(f"{content_of(simulation.parameters().value(PARAMETER)):g}")
        else:
            simulation.set_parameter(PARAMETER, options.factor)


ROUNDING = 1e-6
"""A time this close to the end of a control period, as a fraction of the period, is that end."""


@verb(
    Argument("count", nargs="?", type=int, help="number of control periods (default 1)"),
    Exclusive(
        Argument(
            "--seconds",
            type=positive_number,
            help="advance by this much simulation time, rounded up to a whole control period",
        ),
        Argument(
            "--until",
            type=positive_number,
            metavar="TIME",
            help="advance to the first control period that ends at or after this simulation time",
        ),
    ),
    Flag("--with-sensors", help="take every picture that is due, and wait until all are published"),
    NAMESPACE,
)
def step(options: argparse.Namespace) -> None:
    """Advance the simulation, and wait until the states of the last step have been published."""
    _check(options)
    service = "step_simulation_with_sensors" if options.with_sensors else "step_simulation"
    with ask_simulation(options.namespace) as simulation:
        steps = _steps(options, simulation)
        simulation.ask("StepSimulation", service, patiently=True, steps=steps)


def _check(options: argparse.Namespace) -> None:
    if options.count is None:
        return
    if options.count < 1:
        raise CommandUsageError(f"the number of steps is {options.count}; it must be at least 1")
    if options.seconds is not None or options.until is not None:
        raise CommandUsageError("give a number of steps, or --seconds, or --until")


def _steps(options: argparse.Namespace, simulation: "SimulationClient") -> int:
    seconds: float | None = options.seconds
    end_s: float | None = options.until
    if seconds is None and end_s is None:
        return options.count or 1
    figures = simulation.statistics()["time"]
    period_s, now_s = float(figures["control period (s)"]), float(figures["simulated time (s)"])
    if seconds is not None:
        return max(1, math.ceil(seconds / period_s - ROUNDING))
    assert end_s is not None
    steps = math.ceil((end_s - now_s) / period_s - ROUNDING)
    if steps < 1:
        raise SimulationRefusedError(
            f"the simulation is already at {now_s:.3f} s, past {end_s:g} s"
        )
    return steps
