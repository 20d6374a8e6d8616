"""Finds programs on PATH, as a shell does, and beside this Python."""

import os
import sys

from launch_py.errors import NotFoundError
from launch_py.near_names import describe_known

INSTEAD = {"ros2": "arm"}
"""Programs that ROS launch files run, and the program with the same verbs if they are missing."""


def scripts_folder() -> str:
    """Return the folder of this Python's scripts.

    `arm` also works from a virtual environment that is not activated. The programs that pip
    installed beside it are then not on PATH.
    """
    return os.path.dirname(sys.executable)


def find_program(name: str, path: str) -> str:
    """Return the path of a program.

    Args:
        name: a name, or a path with a slash in it; see INSTEAD.
        path: the folders to search, in the format of the variable PATH.

    Raises:
        NotFoundError: there is no such program; the message suggests similar names.
    """
    if os.sep in name:
        if os.path.isfile(name) and os.access(name, os.X_OK):
            return name
        reason = "is not executable" if os.path.exists(name) else "does not exist"
        raise NotFoundError(f"program {name} {reason}")
    folders = [*filter(None, path.split(os.pathsep)), scripts_folder()]
    for wanted in filter(None, (name, INSTEAD.get(name))):
        for folder in folders:
            candidate = os.path.join(folder, wanted)
            if os.path.isfile(candidate) and os.access(candidate, os.X_OK):
                return candidate
    hint = _near_program(name, folders)
    raise NotFoundError(
        f"no program {name!r} on PATH or in {scripts_folder()}{hint and '; ' + hint}"
    )


def _near_program(name: str, folders: list[str]) -> str:
    """Return a suggestion of programs with similar names, "" if there are none."""
    names: set[str] = set()
    for folder in folders:
        if os.path.isdir(folder):
            names.update(os.listdir(folder))
    hint = describe_known(name, names)
    return hint if hint.startswith("did you mean") else ""
