"""Convert an SDF world to a MuJoCo specification, with its lights and its sky."""

import math
from pathlib import Path

import mujoco

from arm_description.resources import ResourceFinder
from arm_description.transforms import rotation_from_rpy
from arm_description.urdf.robot import Pose
from arm_gazebo.build_report import BuildReport
from arm_gazebo.mesh.library import MeshLibrary
from arm_gazebo.sdf.body import add_model, add_plane
from arm_gazebo.sdf.element import SdfElement, unread_findings
from arm_gazebo.sdf.model import SdfPlane, read_model
from arm_gazebo.sdf.scope import NestedModel, SdfScope, is_sun

GROUND_SIZE_M = 100.0
GROUND_COLOR = (0.8, 0.8, 0.8, 1.0)


def read_sdf_world(path: Path, report: BuildReport) -> mujoco.MjSpec:
    """Return the specification of an SDF world.

    Plain paths in it are relative to its folder. The report gets what is repaired or not simulated.

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
        _add_sky(self._spec, world)
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
                _add_light(self._spec, light)
                continue
            what = f"has the type '{kind}', which is not one of {', '.join(KINDS)}"
            element = f"{light.label} in {light.file_label}"
            self._report.leave_out(element, what, light.line)

    def _add_builtin(self, include: SdfElement) -> None:
        if is_sun(include):
            _add_sun(self._spec)
            return
        size = (GROUND_SIZE_M, GROUND_SIZE_M)
        add_plane(self._spec.worldbody, SdfPlane(Pose(), size, GROUND_COLOR))
        add_plane(self._spec.worldbody, SdfPlane(Pose()))

    def _add(self, model: NestedModel, scope: SdfScope) -> None:
        pose = scope.frames.matrix(model.pose_source)
        for body in read_model(model.scope, model.name, model.static):
            add_model(self._spec, self._meshes, body, pose, self._report)


KINDS = {
    "directional": mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
    "point": mujoco.mjtLightType.mjLIGHT_POINT,
    "spot": mujoco.mjtLightType.mjLIGHT_SPOT,
}
DOWN = (0.0, 0.0, -1.0)
SUN_DIRECTION = (-0.5, 0.1, -0.9)
"""Direction of the light of Gazebo's own sun."""
SUN_HEIGHT_M = 10.0
NO_ATTENUATION = (1.0, 0.0, 0.0)


def _add_sky(spec: mujoco.MjSpec, world: SdfElement) -> None:
    """Add the background and the ambient light that a world's <scene> describes."""
    scene = world.child("scene")
    grey = (0.4, 0.4, 0.4, 1.0)
    ambient = scene.color("ambient", grey) if scene else grey
    spec.visual.headlight.ambient = ambient[:3]
    spec.visual.headlight.diffuse = [0.1] * 3
    spec.visual.headlight.specular = [0.0] * 3
    background = (0.7, 0.7, 0.7, 1.0)
    spec.add_texture(
        name="sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_FLAT,
        rgb1=(scene.color("background", background) if scene else background)[:3],
        width=8,
        height=48,
    )


def _add_light(spec: mujoco.MjSpec, light: SdfElement) -> None:
    """Add a <light>.

    Raises:
        WorldError: a value is invalid.
    """
    kind = light.attribute("type")
    if kind not in KINDS:
        raise light.error(f"has the type '{kind}', which is not one of {', '.join(KINDS)}")
    pose = Pose.of(light.pose().matrix)
    x, y, z = light.numbers("direction", 3, DOWN)
    if not (x or y or z):
        raise light.error("has a direction of zero length")
    added = spec.worldbody.add_light(name=light.name, type=KINDS[kind], pos=pose.xyz)
    added.dir = rotation_from_rpy(pose.rpy) @ (x, y, z)
    added.diffuse = light.color("diffuse", (1.0, 1.0, 1.0, 1.0))[:3]
    added.specular = light.color("specular", (0.1, 0.1, 0.1, 1.0))[:3]
    added.castshadow = light.flag("cast_shadows")
    attenuation = light.child("attenuation")
    if attenuation and kind != "directional":
        # MuJoCo divides by the sum of the three, which may all be 0.
        terms = [attenuation.number(term, 0.0) for term in ("constant", "linear", "quadratic")]
        added.attenuation = terms if sum(terms) > 0 else NO_ATTENUATION
    spot = light.child("spot")
    if spot:
        added.cutoff = min(math.degrees(spot.number("outer_angle")) / 2, 90.0)


def _add_sun(spec: mujoco.MjSpec) -> None:
    """Add Gazebo's own sun, which worlds include by name."""
    spec.worldbody.add_light(
        name="sun",
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        pos=[0.0, 0.0, SUN_HEIGHT_M],
        dir=SUN_DIRECTION,
        diffuse=[0.8] * 3,
        specular=[0.2] * 3,
        castshadow=True,
    )
