"""`arm sim save`, `restore`, `list` and `remove`: snapshots of a running simulation."""

import argparse
from pathlib import Path
from typing import Any

from arm_cli.arguments import JSON, Argument, verb
from arm_cli.output import complain, say, say_answer
from arm_cli.sim.simulation import NAMESPACE, ask_simulation

SUFFIX = ".snapshot"


def _snapshot(name: str) -> Argument:
    return Argument(
        "snapshot",
        metavar="NAME|FILE",
        help=f"{name}; or a file, whose path has a slash or ends with {SUFFIX}",
    )


@verb(_snapshot("a name; a snapshot of that name is replaced"), NAMESPACE)
def save(options: argparse.Namespace) -> None:
    """Save the state of the run; print what was saved."""
    say(_ask(options, "save_snapshot").description)


@verb(_snapshot("a name"), NAMESPACE)
def restore(options: argparse.Namespace) -> None:
    """Continue from a snapshot; print it."""
    moment, _, remark = _ask(options, "restore_snapshot").description.partition("; ")
    say(moment)
    if remark:
        complain(remark)


@verb(JSON, NAMESPACE)
def list_snapshots(options: argparse.Namespace) -> None:
    """Print the snapshots with names."""
    with ask_simulation(options.namespace, must_run=True) as simulation:
        found = simulation.ask("GetAvailableWorlds", "list_snapshots").worlds
    named = {snapshot.world_resource.uri: snapshot.description for snapshot in found}
    say_answer(options, named, map(": ".join, named.items()))


@verb(_snapshot("a name"), NAMESPACE)
def remove(options: argparse.Namespace) -> None:
    """Forget a snapshot, or delete its file."""
    _ask(options, "remove_snapshot")


def _ask(options: argparse.Namespace, service: str) -> Any:
    """Call a service for the snapshot that the options name; return its description."""
    where = options.snapshot
    if "/" in where or where.endswith(SUFFIX):
        # A relative path is relative to this process, not to the simulation's working folder.
        where = str(Path(where).expanduser().absolute())
    with ask_simulation(options.namespace) as simulation:
        from simulation_interfaces.msg import Resource

        resource = Resource(uri=where)
        return simulation.ask("LoadWorld", service, world_resource=resource).world
