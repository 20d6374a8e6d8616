"""World files: MuJoCo XML or SDF by path, or one of the shipped worlds by name."""

from pathlib import Path

import mujoco

from arm_description.errors import ResourceNotFoundError
from arm_description.resources import resolve_uri
from arm_gazebo.build_report import BuildReport
from arm_gazebo.errors import WorldError
from arm_gazebo.sdf.world import read_sdf_world

SDF_SUFFIXES = (".sdf", ".world")
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


def load_world(world: str | Path, report: BuildReport | None = None) -> mujoco.MjSpec:
    """Return the specification of a world, ready to take a robot.

    Args:
        world: a shipped world's name or the path of a file.
        report: gets what of an SDF world is not simulated.

    Raises:
        WorldError: there is no such world, or it is neither MuJoCo XML nor SDF; the message names
            the file.
    """
    path = find_world(world)
    try:
        if path.suffix in SDF_SUFFIXES:
            return read_sdf_world(path, report or BuildReport())
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
    kind = "SDF" if path.suffix in SDF_SUFFIXES else "MuJoCo XML"
    return WorldError(f"the world {path} is not usable {kind}: {reason}")
