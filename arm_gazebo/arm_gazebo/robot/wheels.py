"""Contact of wheels and casters with the floor, so that a robot moves as its wheels turn.

Two properties of MuJoCo's contacts make wheels slip that would not slip in reality:

* A cylinder touches the floor with both rims. In a curve both rims cannot roll, so one always
  slides, and the effective track width is anywhere between that of the inner rims and that of the
  outer rims. A wheel therefore gets the shape of a tyre, an ellipsoid that stands on its middle.
* A sliding contact pushes its shapes apart. MuJoCo damps friction by 2 / (dmax timeconst), about
  100 /s. This damping, times friction and sliding speed, adds to the normal acceleration. A caster
  of friction 1 therefore hops when it is dragged at 0.1 m/s, the wheels lose contact, and the robot
  turns 10 % less than its wheels do. Shapes near the floor that are fixed to the chassis get
  contacts whose friction is damped by 5 /s: from 0.02 m/s on the friction is the same as before,
  and nothing hops.
"""

import itertools
from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.build_report import BuildReport
from arm_gazebo.mjcf.names import free_name
from arm_gazebo.robot.floor_contact import lowest_points, touching_geoms
from arm_node.frozen import frozen

Array = NDArray[np.float64]
GEOM = mujoco.mjtGeom
JOINT = mujoco.mjtJoint

MIN_WHEELS = 2
NEAR_FLOOR_M = 0.005
"""Shapes this close to the robot's lowest point can touch the floor that it rolls on."""
ALIGNED = 0.999
"""Smallest cosine between the axes of a cylinder and its joint that counts as aligned."""
LEVEL = 0.1
"""Largest vertical component of a wheel's unit axis."""
CENTRED_M = 1e-3
SLIDING_DAMPING = 5.0
"""Damping of the friction of sliding contacts, in 1/s; MuJoCo's default is about 100 /s."""
NO_STIFFNESS = -1e-9
"""MuJoCo reads a negative value as the stiffness itself, and 0 as unset."""
MAX_FLOORS = 100
"""Limit on the static shapes that each caster is paired with, planes first."""


@frozen
class _Shapes:
    """Indices of a robot's geoms near the floor."""

    wheels: tuple[int, ...]
    casters: tuple[int, ...]


def set_up_wheels(
    spec: mujoco.MjSpec,
    model: mujoco.MjModel,
    qpos: Array,
    links: Mapping[str, int],
    report: BuildReport,
) -> bool:
    """Round the wheels of a rolling robot, and let its casters slide smoothly.

    Args:
        spec: receives the changes.
        model: compiled from `spec`.
        qpos: starting positions, shape (nq,).
        links: the robot's bodies by name.
        report: receives a note that names the rounded wheels.

    Returns:
        Whether the specification was changed.
    """
    shapes = _find(model, qpos, frozenset(links.values()))
    if len(shapes.wheels) < MIN_WHEELS:
        return False
    geoms = list(spec.geoms)
    for index in shapes.wheels:
        radius, half_width = model.geom_size[index][:2].tolist()
        geoms[index].type = GEOM.mjGEOM_ELLIPSOID
        geoms[index].size = [radius, radius, half_width]
    wheels = dict.fromkeys(model.body(model.geom_bodyid[index]).name for index in shapes.wheels)
    names = ", ".join(f"'{name}'" for name in wheels)
    report.inform(f"links {names}", "they are wheels; their cylinders are rounded like a tyre")
    pairs = itertools.product(shapes.casters, _floors(model, frozenset(links.values())))
    for caster, floor in pairs:
        _add_pair(spec, model, geoms, caster, floor)
    return True


def _find(model: mujoco.MjModel, qpos: Array, bodies: frozenset[int]) -> _Shapes:
    """Return the robot's geoms near the floor: wheels, and shapes that are fixed to the chassis."""
    roots = {int(model.body_rootid[body]) for body in bodies} - {0}
    free = {
        root
        for root in roots
        if model.body_jntnum[root] and model.jnt_type[model.body_jntadr[root]] == JOINT.mjJNT_FREE
    }
    if not free:
        return _Shapes((), ())
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    standing = np.zeros(model.nbody, bool)
    standing[[body for body in bodies if model.body_rootid[body] in free]] = True
    heights = lowest_points(model, data, touching_geoms(model, standing))
    floor = min(heights.values(), default=0.0)
    near = sorted(geom for geom, height in heights.items() if height < floor + NEAR_FLOOR_M)
    wheels = tuple(geom for geom in near if _is_wheel(model, data, geom))
    casters = tuple(geom for geom in near if model.body_weldid[model.geom_bodyid[geom]] in free)
    return _Shapes(wheels, casters)


def _is_wheel(model: mujoco.MjModel, data: mujoco.MjData, geom: int) -> bool:
    """Return whether a geom is a cylinder around a horizontal continuous joint."""
    body = int(model.body_weldid[model.geom_bodyid[geom]])
    if model.geom_type[geom] != GEOM.mjGEOM_CYLINDER or model.body_jntnum[body] != 1:
        return False
    joint = int(model.body_jntadr[body])
    if model.jnt_type[joint] != JOINT.mjJNT_HINGE or model.jnt_limited[joint]:
        return False
    axis, anchor = _axis(model, data, body, joint)
    own = data.geom_xmat[geom].reshape(3, 3)[:, 2]
    beside = data.geom_xpos[geom] - anchor
    beside -= beside.dot(axis) * axis
    aligned = abs(own.dot(axis)) > ALIGNED and np.linalg.norm(beside) < CENTRED_M
    return bool(aligned and abs(axis[2]) < LEVEL)


def _axis(model: mujoco.MjModel, data: mujoco.MjData, body: int, joint: int) -> tuple[Array, Array]:
    """Return the axis and the anchor of a joint in the world, shape (3,) each."""
    rotation = data.xmat[body].reshape(3, 3)
    return rotation @ model.jnt_axis[joint], data.xpos[body] + rotation @ model.jnt_pos[joint]


def _floors(model: mujoco.MjModel, bodies: frozenset[int]) -> list[int]:
    """Return the static collision geoms of the world."""
    standing = [
        geom
        for geom in range(model.ngeom)
        if model.body_weldid[model.geom_bodyid[geom]] == 0
        and int(model.geom_bodyid[geom]) not in bodies - {0}
        and (model.geom_contype[geom] or model.geom_conaffinity[geom])
    ]
    standing.sort(key=lambda geom: model.geom_type[geom] != GEOM.mjGEOM_PLANE)
    return standing[:MAX_FLOORS]


def _add_pair(
    spec: mujoco.MjSpec,
    model: mujoco.MjModel,
    geoms: list[mujoco.MjsGeom],
    caster: int,
    floor: int,
) -> None:
    """Pair two geoms as MuJoCo itself would, except for the damping of their friction."""
    both = [caster, floor]
    touch = model.geom_contype[caster] & model.geom_conaffinity[floor]
    if not (touch or model.geom_contype[floor] & model.geom_conaffinity[caster]):
        return
    for index in both:
        if not geoms[index].name:
            taken = {geom.name for geom in geoms}
            geoms[index].name = free_name(f"{geoms[index].parent.name}::shape", taken)
    slide, spin, roll = _contact_values(model, both, model.geom_friction, np.max)
    spec.add_pair(
        geomname1=geoms[caster].name,
        geomname2=geoms[floor].name,
        condim=int(_contact_values(model, both, model.geom_condim[:, None], np.max)[0]),
        friction=[slide, slide, spin, roll, roll],
        solref=_contact_values(model, both, model.geom_solref, np.mean),
        solimp=_contact_values(model, both, model.geom_solimp, np.mean),
        solreffriction=[NO_STIFFNESS, -SLIDING_DAMPING],
        margin=float(model.geom_margin[both].sum()),
        gap=float(model.geom_gap[both].sum()),
    )


def _contact_values(
    model: mujoco.MjModel, both: list[int], values: Array, rule: Any
) -> list[float]:
    """Return a contact parameter: from the geom with priority, or from both by a rule."""
    one, other = model.geom_priority[both].tolist()
    if one != other:
        return values[both[one < other]].tolist()
    return rule(values[both], axis=0).tolist()
