"""`arm launch`: the simulated arm, or any launch file, under launch_py's supervisor."""

from collections.abc import Sequence

from launch_py import LaunchError
from launch_py.command_line import run as run_launch

SHORT_NAMES = {
    "": ("arm_gazebo", "arm_gazebo.launch.py"),
    "mycobot": ("mycobot_gazebo", "mycobot.gazebo.launch.py"),
}


def run(argv: Sequence[str]) -> int:
    """Launch; return the exit code."""
    return run_launch(
        argv, program="arm launch", short_names=SHORT_NAMES, before_start=_check_environment
    )


def _check_environment() -> None:
    """Refuse to start processes that would all fail for the same reason.

    Raises:
        LaunchError: ROS cannot start in this environment; the message says the fix.
    """
    from arm_node.environment import UnusableEnvironmentError, prepare_environment

    try:
        prepare_environment()
    except UnusableEnvironmentError as error:
        raise LaunchError(str(error)) from error
