"""The command line of the launch that a test requests."""

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from arm_sim.bench.errors import BenchError

ROBOTS: Mapping[str, Sequence[str]] = {"arm": (), "mycobot": ("mycobot",)}
"""What `arm launch` takes for a robot that has a name."""
SIMULATION = ("arm_gazebo", "sim.launch.py")
"""The launch file of any other robot."""


def launch_command(
    *,
    robot: str | None = None,
    world: str | None = None,
    controllers: str | None = None,
    launch: str | Sequence[str] | None = None,
    arguments: Mapping[str, object] | None = None,
    record_to: Path | None = None,
) -> list[str]:
    """Return the command.

    Args:
        robot: "arm", "mycobot", or a URDF or xacro file.
        world: a shipped world's name, or a file.
        controllers: the controllers' parameter file.
        launch: a launch file of your own, or a package and its launch file, instead of a robot.
        arguments: more launch arguments.
        record_to: file to record the run to; the launch of your own file is not recorded.

    Raises:
        BenchError: both a robot and a launch file are given.
    """
    if robot is not None and launch is not None:
        raise BenchError("name a robot or a launch file, not both")
    given: dict[str, object] = {"world": world, "controllers": controllers}
    if launch is None and record_to is not None:
        record_to.parent.mkdir(parents=True, exist_ok=True)
        given["record_run"] = record_to
    if launch is not None:
        words = [launch] if isinstance(launch, str) else list(launch)
    elif robot is None or robot in ROBOTS:
        words = list(ROBOTS[robot or "arm"])
    else:
        words = list(SIMULATION)
        given["model"] = robot
    given.update(arguments or {})
    assigned = [f"{name}:={_text(value)}" for name, value in given.items() if value is not None]
    return [sys.executable, "-P", "-m", "arm_cli", "launch", *words, *assigned]


def _text(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
