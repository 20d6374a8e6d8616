"""Read world files: MuJoCo XML or SDF."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import mujoco

from arm_description.errors import XmlError
from arm_gazebo.build_report import BuildReport
from arm_gazebo.errors import ModelError, WorldError
from arm_gazebo.launching.world_path import find_world
from arm_gazebo.mjcf.memory_limit import WORLD_LIMIT, MemoryLimit
from arm_gazebo.mjcf.references import check_readable
from arm_gazebo.mjcf.size import check_mjcf_size
from arm_node.user_file import read_text

SDF_SUFFIXES = (".sdf", ".world")


def load_world(
    world: str | Path, report: BuildReport | None = None, limit: MemoryLimit = WORLD_LIMIT
) -> mujoco.MjSpec:
    """Return the specification of a world that robots can be added to.

    Args:
        world: name of a shipped world, or path of a file.
        report: receives what is not simulated.
        limit: limit on the memory of an MJCF.

    Raises:
        WorldError: the world does not exist, is neither MuJoCo XML nor SDF, or is too large;
            the message names the file.
    """
    path = find_world(world)
    try:
        if path.suffix in SDF_SUFFIXES:
            # Imported here, because most worlds are MuJoCo's.
            from arm_gazebo.sdf.world import read_sdf_world

            return read_sdf_world(path, report or BuildReport())
        text = read_text(path)
        check_readable(text, path)
        check_mjcf_size(text, path.name, path, limit)
        spec = mujoco.MjSpec.from_file(str(path))
        if report is not None:
            _report_unused(spec, path.name, report)
            report_margins(spec, path.name, report)
        return spec
    except OSError as error:
        raise WorldError(f"cannot read the world {path}: {error}") from error
    except (ModelError, XmlError, ValueError, mujoco.FatalError) as error:
        raise _unusable(path, error) from error


def _report_unused(spec: mujoco.MjSpec, file: str, report: BuildReport) -> None:
    """Report what MuJoCo itself would use of a file, and the simulation does not."""
    step_s = spec.option.timestep
    if step_s != mujoco.MjSpec().option.timestep:
        report.drop(
            f"<option timestep='{step_s:g}'> of {file}",
            "the physics step divides the control period; the parameter physics_step changes it",
        )
    if spec.keys:
        report.drop(_named("keyframe", spec.keys, file), "the world starts at its joints' qpos0")
    if spec.actuators:
        report.warn(
            _named("actuator", spec.actuators, file),
            "nothing commands what belongs to no robot, so the control stays 0",
        )
    if spec.sensors:
        report.drop(_named("sensor", spec.sensors, file), "it is not read")


def _named(kind: str, elements: Sequence[Any], file: str) -> str:
    more = f" and {len(elements) - 1} more" if len(elements) > 1 else ""
    name = f" '{elements[0].name}'" if elements[0].name else ""
    return f"{kind}{name} of {file}{more}"


def report_margins(spec: mujoco.MjSpec, file: str, report: BuildReport) -> None:
    """Report the geoms and pairs with both a margin and a gap, one warning for each kind."""
    for kind, elements in (("geom", spec.geoms), ("pair", spec.pairs)):
        both = [element for element in elements if element.margin > 0.0 and element.gap > 0.0]
        if not both:
            continue
        margin = both[0].margin
        before = margin - both[0].gap
        report.warn(
            _named(kind, both, file),
            f"it pushes at {margin:g} m from its surface, the margin. Up to MuJoCo 3.8 it "
            f"pushed at margin minus gap, {before:g} m: for that write margin='{before:g}'",
        )


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
