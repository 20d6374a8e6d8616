"""Where worlds are: a file by its path, or one of the shipped worlds by name.

Apart from what reads them, so that a launch file can look without loading MuJoCo.
"""

from pathlib import Path

from arm_description.errors import ResourceNotFoundError
from arm_description.resources import resolve_uri
from arm_gazebo.errors import WorldError

SHIPPED_WORLDS_URI = "package://arm_gazebo/worlds"


def shipped_worlds() -> dict[str, Path]:
    """Return the files of the shipped worlds by name."""
    try:
        folder = resolve_uri(SHIPPED_WORLDS_URI)
    except ResourceNotFoundError:
        return {}
    return {file.stem: file for file in sorted(folder.glob("*.xml"))}


def find_world(world: str | Path) -> Path:
    """Return the file of a world that is named or given by its path.

    Raises:
        WorldError: neither a shipped name nor an existing file.
    """
    shipped = shipped_worlds()
    if str(world) in shipped:
        return shipped[str(world)]
    path = Path(world).expanduser()
    if path.is_file():
        return path
    raise WorldError(
        f"no world '{world}': it is no file ({path.absolute()}), and the shipped worlds are "
        f"{', '.join(shipped) or 'not installed'}"
    )
