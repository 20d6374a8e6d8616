"""Find a world: a file by its path, or a shipped world by name.

Separate from the readers, so that a launch file can look up a world without loading MuJoCo.
"""

import os
from pathlib import Path

from arm_description.package_search import suite_package
from arm_gazebo.errors import WorldError
from arm_node.user_file import check_file

PACKAGE = "arm_gazebo"


def shipped_worlds() -> dict[str, Path]:
    """Return the files of the shipped worlds by name."""
    package = suite_package(PACKAGE)
    files = [] if package is None else sorted((package / "worlds").glob("*.xml"))
    return {file.stem: file for file in files}


def find_world(world: str | Path) -> Path:
    """Return the file of a world that is given by its name or path.

    Raises:
        WorldError: it is neither a shipped world nor a regular file that can be read.
    """
    shipped = shipped_worlds()
    if str(world) in shipped:
        return shipped[str(world)]
    path = Path(world).expanduser()
    if str(world) and os.path.exists(path):
        try:
            check_file(path)
        except OSError as error:
            raise WorldError(f"cannot read the world {path}: {error.strerror}") from error
        return path
    problem = f"there is no file {path.absolute()}" if str(world) else "the name is empty"
    raise WorldError(
        f"no world '{world}': {problem}, and the shipped worlds are "
        f"{', '.join(shipped) or 'not installed'}"
    )
