"""Gazebo's own command line, as far as it says something to this simulation."""

import shlex
from pathlib import Path

from arm_gazebo.errors import SettingsError

RUN = "-r"
SERVER_ONLY = "-s"
VERBOSITY = "-v"
LEVELS = ("fatal", "error", "warn", "info", "info")
"""What Gazebo's -v 0 to -v 4 let through, in ROS's words; its debug shows rcl's work, not ours."""
LET_BE = ("--headless-rendering",)
"""Cameras need no display here anyway."""
WORLD_SUFFIXES = (".sdf", ".world")
KNOWN = f"the words known are {RUN}, {SERVER_ONLY}, {VERBOSITY} 0 to {VERBOSITY} 4 and a world"


def launch_arguments(gz_args: str) -> dict[str, str]:
    """Return the launch arguments that stand for Gazebo's words.

    `-r -v 4 objects.sdf` is world:=objects log_level:=info. A world is meant by its name, which
    may end as Gazebo's files do, or by its path.

    Raises:
        SettingsError: a word that means nothing here; the message names those that do.
    """
    try:
        words = shlex.split(gz_args)
    except ValueError as error:
        raise SettingsError(f"gz_args {gz_args!r} has {str(error).lower()}") from error
    meant: dict[str, str] = {}
    rest = iter(words)
    for word in rest:
        if word.startswith(VERBOSITY):
            meant["log_level"] = _level(word.removeprefix(VERBOSITY) or next(rest, ""))
        elif word == SERVER_ONLY:
            meant["headless"] = "true"
        elif word.startswith("-"):
            if word not in (RUN, *LET_BE):
                raise SettingsError(f"gz_args has {word!r}; {KNOWN}")
        elif "world" in meant:
            raise SettingsError(f"gz_args names two worlds, {meant['world']!r} and {word!r}")
        else:
            meant["world"] = _world(word)
    if words and RUN not in words:
        raise SettingsError(
            f"gz_args {gz_args!r} lacks {RUN}: Gazebo would start paused, and this simulation "
            f"always runs from its start; add {RUN}"
        )
    return meant


def _level(number: str) -> str:
    try:
        return LEVELS[("0", "1", "2", "3", "4").index(number)]
    except ValueError:
        raise SettingsError(f"gz_args has {VERBOSITY} {number!r}; it takes 0 to 4") from None


def _world(word: str) -> str:
    path = Path(word)
    return path.stem if path.suffix in WORLD_SUFFIXES and not path.is_file() else word
