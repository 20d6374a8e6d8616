"""`arm sim save`, `restore`, `list` and `remove`: snapshots of a running simulation."""

import argparse
from pathlib import Path
from typing import Any

from arm_cli.output import add_json_argument, complain, print_json, say
from arm_cli.sim.simulation import add_namespace_argument, ask_simulation
from arm_cli.verb import VerbFunctions

SUFFIX = ".snapshot"


def add_save_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    _add_snapshot_argument(parser, "a name; a snapshot of that name is replaced")


def save(options: argparse.Namespace) -> None:
    """Save the state of the run; print what was saved.

    Raises:
        SimulationRefusedError: a controller cannot be saved, or the file cannot be written.
    """
    say(_ask(options, "save_snapshot").description)


def add_restore_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    _add_snapshot_argument(parser, "a name")


def restore(options: argparse.Namespace) -> None:
    """Continue from a snapshot; print it.

    Raises:
        SimulationRefusedError: there is none, or it does not fit the simulation.
    """
    moment, _, remark = _ask(options, "restore_snapshot").description.partition("; ")
    say(moment)
    if remark:
        complain(remark)


def add_list_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    add_json_argument(parser)
    add_namespace_argument(parser)


def list_snapshots(options: argparse.Namespace) -> None:
    """Print the snapshots with names.

    Raises:
        NoSuchNameError: no simulation runs.
    """
    with ask_simulation(options, must_run=True) as simulation:
        found = simulation.ask("GetAvailableWorlds", "list_snapshots").worlds
    named = {snapshot.world_resource.uri: snapshot.description for snapshot in found}
    if options.json:
        print_json(named)
        return
    for name, description in named.items():
        say(f"{name}: {description}")


def add_remove_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    _add_snapshot_argument(parser, "a name")


def remove(options: argparse.Namespace) -> None:
    """Forget a snapshot, or delete its file.

    Raises:
        SimulationRefusedError: there is none.
    """
    _ask(options, "remove_snapshot")


def _add_snapshot_argument(parser: argparse.ArgumentParser, name: str) -> None:
    parser.add_argument(
        "snapshot",
        metavar="NAME|FILE",
        help=f"{name}; or a file, whose path has a slash or ends with {SUFFIX}",
    )
    add_namespace_argument(parser)


def _ask(options: argparse.Namespace, service: str) -> Any:
    """Call a service for the snapshot that the options name; return its description."""
    where = options.snapshot
    if "/" in where or where.endswith(SUFFIX):
        # A relative path is relative to this process, not to the simulation's working folder.
        where = str(Path(where).expanduser().absolute())
    with ask_simulation(options) as simulation:
        from simulation_interfaces.msg import Resource

        resource = Resource(uri=where)
        return simulation.ask("LoadWorld", service, world_resource=resource).world


SAVE = VerbFunctions(add_save_arguments, save)
RESTORE = VerbFunctions(add_restore_arguments, restore)
LIST = VerbFunctions(add_list_arguments, list_snapshots)
REMOVE = VerbFunctions(add_remove_arguments, remove)
