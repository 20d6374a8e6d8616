"""What world files hold: MuJoCo XML or SDF."""

from pathlib import Path

import mujoco

from arm_gazebo.build_report import BuildReport
from arm_gazebo.errors import WorldError
from arm_gazebo.model.world_path import find_world
from arm_gazebo.sdf.world import read_sdf_world

SDF_SUFFIXES = (".sdf", ".world")


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
