"""Convert an SDF world to a MuJoCo specification."""

from pathlib import Path

import mujoco

from arm_description.resources import ResourceFinder
from arm_description.urdf.robot import Pose
from arm_gazebo.build_report import BuildReport
from arm_gazebo.mesh.library import MeshLibrary
from arm_gazebo.sdf.body import add_model, add_plane
from arm_gazebo.sdf.element import SdfElement, unread_findings
from arm_gazebo.sdf.include import is_sun
from arm_gazebo.sdf.light import KINDS, add_light, add_sky, add_sun
from arm_gazebo.sdf.model import SdfPlane, read_model
from arm_gazebo.sdf.scope import NestedModel, SdfScope

GROUND_SIZE_M = 100.0
GROUND_COLOR = (0.8, 0.8, 0.8, 1.0)


def read_sdf_world(path: Path, report: BuildReport) -> mujoco.MjSpec:
    """Return the specification of an SDF world.

    Args:
        path: path of the file; plain paths in it are relative to its folder.
        report: receives what is repaired and what is not simulated.

    Raises:
        WorldError: the file is not SDF, or a value in it is invalid; the message names file, line
            and element.
    """
    root = SdfElement.read(path)
    reader = _WorldReader(root.required("world"), report)
    return reader.read()


class _WorldReader:
    """Adds the content of a <world> to a specification."""

    def __init__(self, world: SdfElement, report: BuildReport) -> None:
        self._world = world
        self._report = report
        self._spec = mujoco.MjSpec()
        self._spec.compiler.degree = False
        # As in the shipped worlds, so that objects held by friction do not creep.
        self._spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        self._spec.option.impratio = 10.0
        self._meshes = MeshLibrary(self._spec, ResourceFinder(world.source))

    def read(self) -> mujoco.MjSpec:
        """Return the specification of the whole world."""
        world = self._world
        self._spec.modelname = world.name or "world"
        self._spec.option.gravity = world.numbers("gravity", 3, (0.0, 0.0, -9.8))
        add_sky(self._spec, world)
        self._add_lights(world)
        scope = SdfScope(world)
        for model in scope.models.values():
            self._add(model, scope)
        for include in scope.builtin_includes:
            self._add_builtin(include)
        self._report.add(*unread_findings([world, *scope.files]))
        return self._spec

    def _add_lights(self, owner: SdfElement) -> None:
        for light in owner.children("light"):
            kind = light.attribute("type")
            if kind in KINDS:
                add_light(self._spec, light)
                continue
            what = f"has the type '{kind}', which is not one of {', '.join(KINDS)}"
            element = f"{light.label} in {light.file_label}"
            self._report.leave_out(element, what, light.line)

    def _add_builtin(self, include: SdfElement) -> None:
        if is_sun(include):
            add_sun(self._spec)
            return
        size = (GROUND_SIZE_M, GROUND_SIZE_M)
        add_plane(self._spec.worldbody, SdfPlane(Pose(), size, GROUND_COLOR))
        add_plane(self._spec.worldbody, SdfPlane(Pose()))

    def _add(self, model: NestedModel, scope: SdfScope) -> None:
        pose = scope.frames.matrix(model.pose_source)
        for body in read_model(model.scope, model.name, model.static):
            add_model(self._spec, self._meshes, body, pose, self._report)
