"""`arm gz model` and `arm gz service`: the simulation's models and services."""

import argparse
from typing import Any

from arm_cli.arguments import Argument, Flag, verb
from arm_cli.errors import CommandUsageError, NoSuchNameError
from arm_cli.gz.topic import world_name
from arm_cli.output import say
from arm_cli.sim.simulation import ask_simulation
from arm_node.names import describe_known
from arm_node.rigid_transform import RigidTransform

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
    """List the models, or print the pose of one.

    Raises:
        CommandUsageError: neither --list nor -m is given.
        NoSuchNameError: there is no such model.
        UnansweredError: no simulation answers.
    """
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
    """List the services, or print what to use instead of one.

    Raises:
        CommandUsageError: neither -l nor -s is given, or a service is called.
        NoSuchNameError: there is no such service.
        UnansweredError: no simulation answers.
    """
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
