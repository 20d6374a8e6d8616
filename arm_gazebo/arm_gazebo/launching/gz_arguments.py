"""Translate the options of Gazebo's command line that apply to this simulation."""

import os
import shlex
from pathlib import Path

from arm_gazebo.errors import SimSettingsError

RUN = "-r"
SERVER_ONLY = "-s"
VERBOSITY = "-v"
LEVELS = ("fatal", "error", "warn", "info", "info")
"""ROS log levels for Gazebo's -v 0 to -v 4. ROS's debug level is not used, because it mostly shows
rcl's own messages."""
IGNORED = ("--headless-rendering",)
"""Options without effect, because cameras never need a display here."""
WORLD_SUFFIXES = (".sdf", ".world")
KNOWN = f"it takes {RUN}, {SERVER_ONLY}, {VERBOSITY} 0 to {VERBOSITY} 4 and a world"


def launch_arguments(gz_args: str) -> dict[str, str]:
    """Return the launch arguments that correspond to Gazebo's options.

    `-r -v 4 objects.sdf` is world:=objects log_level:=info. A world is given by its path or by its
    name, which may have the suffix of a Gazebo file. Words without `-r` start paused, as in Gazebo;
    no words at all start running.

    Raises:
        SimSettingsError: an option is unknown; the message names the known ones.
    """
    try:
        words = shlex.split(gz_args)
    except ValueError as error:
        raise SimSettingsError(f"gz_args {gz_args!r} has {str(error).lower()}") from error
    arguments: dict[str, str] = {}
    rest = iter(words)
    for word in rest:
        if word.startswith(VERBOSITY):
            arguments["log_level"] = _level(word.removeprefix(VERBOSITY) or next(rest, ""))
        elif word == SERVER_ONLY:
            arguments["headless"] = "true"
        elif word.startswith("-"):
            if word not in (RUN, *IGNORED):
                raise SimSettingsError(f"gz_args has {word!r}; {KNOWN}")
        elif "world" in arguments:
            raise SimSettingsError(f"gz_args names two worlds, {arguments['world']!r} and {word!r}")
        else:
            arguments["world"] = _world(word)
    if words and RUN not in words:
        arguments["paused"] = "true"
    return arguments


def _level(number: str) -> str:
    try:
        return LEVELS[("0", "1", "2", "3", "4").index(number)]
    except ValueError:
        raise SimSettingsError(f"gz_args has {VERBOSITY} {number!r}; it takes 0 to 4") from None


def _world(word: str) -> str:
    path = Path(word)
    return path.stem if path.suffix in WORLD_SUFFIXES and not os.path.isfile(path) else word
