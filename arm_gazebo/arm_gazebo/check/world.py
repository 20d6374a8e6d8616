"""Read a world, or a model to spawn, as the simulation would, and report all findings."""

from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

from arm_description.errors import DescriptionError, XmlError
from arm_description.urdf.xml_document import parse_xml
from arm_gazebo.build_report import BuildReport
from arm_gazebo.check.description import CheckResult, counted, failures
from arm_gazebo.errors import GazeboError
from arm_gazebo.mjcf.names import name_elements
from arm_gazebo.model.world_file import SDF_SUFFIXES, load_world
from arm_gazebo.physics_timing import MAX_STEP_S
from arm_gazebo.world.spawn_model import ModelSource
from arm_node.user_file import read_text

SUFFIXES = (*SDF_SUFFIXES, ".xml", ".mjcf")
FREE = mujoco.mjtJoint.mjJNT_FREE
WORLD_ROOTS = ("sdf", "mujoco")


@dataclass(frozen=True, slots=True)
class WorldSummary:
    """A summary of a world.

    Attributes:
        name: name of the world or model.
        things: names of the top-level bodies.
        free: number of top-level bodies that move freely.
        jointed: number of other top-level bodies with parts that move.
        shapes: number of visual and collision shapes.
        lights: number of lights.
        left_out: what is missing, in one line; "" if nothing is.
    """

    name: str
    things: tuple[str, ...]
    free: int
    jointed: int
    shapes: int
    lights: int
    left_out: str

    def __str__(self) -> str:
        parts = [
            f"{counted(len(self.things), 'thing')}, {self.free} of them free to move",
            *([f"{self.jointed} with joints"] if self.jointed else []),
            counted(self.shapes, "shape"),
            counted(self.lights, "light"),
        ]
        missing = f"; {self.left_out}" if self.left_out else ""
        return f"world '{self.name}': {', '.join(parts)}{missing}"


def is_world(path: Path) -> bool:
    """Return whether a file is SDF or MuJoCo XML, by its suffix and its root element.

    For a file that cannot be read only the suffix counts.
    """
    if path.suffix in SDF_SUFFIXES:
        return True
    if path.suffix not in SUFFIXES:
        return False
    try:
        return str(parse_xml(read_text(path), str(path)).tag) in WORLD_ROOTS
    except (XmlError, OSError, UnicodeDecodeError):
        return False


def check_world_file(path: Path) -> CheckResult[WorldSummary]:
    """Check a world in SDF or MuJoCo XML, or a single SDF model."""
    report = BuildReport()
    world = None
    with failures(report, str(path)):
        try:
            world = _summary(path, report)
        except (ValueError, mujoco.FatalError) as error:
            raise GazeboError(f"it does not compile: {' '.join(str(error).split())}") from error
    return CheckResult(world, tuple(dict.fromkeys(report.findings)))


def _summary(path: Path, report: BuildReport) -> WorldSummary:
    if path.suffix in SDF_SUFFIXES and _is_single_model(path):
        spawned = ModelSource(MAX_STEP_S).read(str(path.absolute()), "")
        report.add(*spawned.findings)
        spec = spawned.spec.copy()
    else:
        spec = load_world(path, report)
    name_elements(spec)
    model = spec.compile()
    below = np.flatnonzero(model.body_parentid == 0)[1:]
    moving = [body for body in below if model.body_dofnum[body]]
    free = {body for body in moving if model.jnt_type[model.body_jntadr[body]] == FREE}
    return WorldSummary(
        name=path.stem,
        things=tuple(model.body(body).name for body in below),
        free=len(free),
        jointed=sum(
            bool(model.body_dofnum[model.body_rootid == body].any()) for body in {*below} - free
        ),
        shapes=int(model.ngeom),
        lights=int(model.nlight),
        left_out=report.left_out,
    )


def _is_single_model(path: Path) -> bool:
    try:
        root = parse_xml(read_text(path), str(path))
    except (DescriptionError, OSError, UnicodeDecodeError):
        return False
    return root.find("world") is None and root.find("model") is not None
