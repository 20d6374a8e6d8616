"""Where every verb that talks to ROS begins."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from arm_cli.errors import UsageError
from arm_node.environment import UnusableEnvironmentError, prepare_environment
from arm_node.local_profile import PROFILE, use_local_profile
from launch_py.child_environment import dds_profile
from launch_py.library_output import library_output_on_stderr

if TYPE_CHECKING:
    from arm_cli.ros.session import Session


@contextmanager
def connect(name: str | None = None, use_sim_time: bool = False) -> Iterator["Session"]:
    """Give a node for this command; see `open_session`.

    The process announces itself as often as the launched ones do, unless the user has a profile:
    whoever is there answers at once. Meanwhile stdout is for what Python prints alone.

    Raises:
        UsageError: ROS cannot start in this environment; the message says the fix.
    """
    try:
        prepare_environment()
    except UnusableEnvironmentError as error:
        raise UsageError(str(error)) from error
    profile = dds_profile(os.environ)
    if profile is not None:
        os.environ.setdefault(PROFILE, str(profile))
        use_local_profile(os.environ)
    from arm_cli.ros.session import open_session

    with library_output_on_stderr(), open_session(name, use_sim_time) as session:
        yield session
