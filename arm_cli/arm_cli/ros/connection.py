"""Connects a verb to ROS."""

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from arm_cli.errors import CommandUsageError
from arm_node.environment import UnusableEnvironmentError, prepare_environment
from arm_node.workarounds.local_profile import use_local_profile
from launch_py.fast_dds.removal import remove_abandoned
from launch_py.standard_streams import library_output_on_stderr
from launch_py.system.dds_profile import shipped_profile

if TYPE_CHECKING:
    from arm_cli.ros.graph import Graph
    from arm_cli.ros.session import CommandSession


@contextmanager
def connect(
    name: str | None = None, use_sim_time: bool = False, packages: Sequence[str] = ()
) -> Iterator["CommandSession"]:
    """Yield a session with a node for this command; see `open_session` and `prepare_environment`.

    Unless the user has a DDS profile, the process announces itself as often as launched processes
    do, so that it discovers others at once. Shared memory of killed processes is removed. stdout is
    reserved for Python's output meanwhile.

    Raises:
        CommandUsageError: ROS cannot start in this environment; the message says how to fix it.
    """
    try:
        prepare_environment(packages=packages)
    except UnusableEnvironmentError as error:
        raise CommandUsageError(str(error)) from error
    remove_abandoned()
    os.environ.update(shipped_profile(os.environ))
    use_local_profile(os.environ)
    from arm_cli.ros.session import open_session

    with library_output_on_stderr(), open_session(name, use_sim_time) as session:
        yield session


@contextmanager
def settled_graph() -> Iterator["Graph"]:
    """Yield the ROS graph when its discovery has settled; see `connect` and `Graph.settle`."""
    with connect() as session:
        from arm_cli.ros.graph import Graph

        graph = Graph(session)
        graph.settle()
        yield graph
