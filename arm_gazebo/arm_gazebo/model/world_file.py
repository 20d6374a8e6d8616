"""Read world files: MuJoCo XML or SDF."""

from pathlib import Path

import mujoco

from arm_description.errors import XmlError
from arm_gazebo.errors import ModelError, WorldError
from arm_gazebo.launching.world_path import find_world
from arm_gazebo.sdf.world import read_sdf_world
from arm_gazebo.spec.mjcf_references import check_readable
from arm_gazebo.spec.mjcf_size import WORLD_LIMIT, MemoryLimit, check_mjcf_size
from arm_gazebo.spec.report import BuildReport
from arm_node.user_file import read_text

SDF_SUFFIXES = (".sdf", ".world")


def load_world(
    world: str | Path, report: BuildReport | None = None, limit: MemoryLimit = WORLD_LIMIT
) -> mujoco.MjSpec:
    """Return the specification of a world that robots can be added to.

    Args:
        world: name of a shipped world, or path of a file.
        report: receives what is not simulated in an SDF world.
        limit: limit on the memory of an MJCF.

    Raises:
        WorldError: the world does not exist, is neither MuJoCo XML nor SDF, or is too large;
            the message names the file.
    """
    path = find_world(world)
    try:
        if path.suffix in SDF_SUFFIXES:
            return read_sdf_world(path, report or BuildReport())
        text = read_text(path)
        check_readable(text, path)
        check_mjcf_size(text, path.name, path, limit)
        return mujoco.MjSpec.from_file(str(path))
    except OSError as error:
        raise WorldError(f"cannot read the world {path}: {error}") from error
    except (ModelError, XmlError, ValueError, mujoco.FatalError) as error:
        raise _unusable(path, error) from error


def check_world(world: str | Path) -> None:
    """Raise a WorldError if a world does not compile without robots.

    It separates errors in the world from errors in a robot after both together failed to compile.
    """
    spec = load_world(world)
    try:
        spec.compile()
    except (ValueError, mujoco.FatalError) as error:
        raise _unusable(find_world(world), error) from error


def _unusable(path: Path, error: Exception) -> WorldError:
    reason = " ".join(str(error).split()).removeprefix(f"{path.name}: ")
    kind = "SDF" if path.suffix in SDF_SUFFIXES else "MuJoCo XML"
    return WorldError(f"the world {path} is not usable {kind}: {reason}")
