"""Add the lights and the sky of an SDF world."""

import math

import mujoco

from arm_description.transforms import rotation_from_rpy
from arm_gazebo.sdf.element import SdfElement
from arm_gazebo.sdf.frames import pose_of

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


def add_sky(spec: mujoco.MjSpec, world: SdfElement) -> None:
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


def add_light(spec: mujoco.MjSpec, light: SdfElement) -> None:
    """Add a <light>.

    Raises:
        WorldError: a value is invalid.
    """
    kind = light.attribute("type")
    if kind not in KINDS:
        raise light.error(f"has the type '{kind}', which is not one of {', '.join(KINDS)}")
    pose = pose_of(light.pose().matrix)
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


def add_sun(spec: mujoco.MjSpec) -> None:
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
