"""World files: MuJoCo XML by path, or one of the shipped worlds by name."""

from pathlib import Path

import mujoco

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


def load_world(world: str | Path) -> mujoco.MjSpec:
    """Return the specification of a world, ready to take a robot.

    Raises:
        WorldError: there is no such world, or it is not MuJoCo XML; the message names the file.
    """
    path = find_world(world)
    try:
        return mujoco.MjSpec.from_file(str(path))
    except (ValueError, mujoco.FatalError) as error:
        raise _unusable(path, error) from error


def check_world(world: str | Path) -> None:
    """Raise a WorldError where a world does not compile by itself.

    Tells a world's mistakes from a robot's, once both together have failed.
    """
    spec = load_world(world)
    try:
        spec.compile()
    except (ValueError, mujoco.FatalError) as error:
        raise _unusable(find_world(world), error) from error


def _unusable(path: Path, error: Exception) -> WorldError:
    reason = " ".join(str(error).split())
    return WorldError(f"the world {path} is not usable MuJoCo XML: {reason}")
