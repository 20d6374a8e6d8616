"""Report links of a robot that start below the floor, inside something, or inside each other."""

from collections.abc import Iterable, Iterator, Mapping

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.build_report import BuildReport
from arm_gazebo.robot.collision_policy import jointed_pairs
from arm_gazebo.robot.floor_contact import lowest_points

PLANE = mujoco.mjtGeom.mjGEOM_PLANE
LEVEL = 1.0 - 1e-9
SHALLOW_M = 1e-3
"""Overlaps up to this are rounding errors of a mesh, or of a foot on the floor."""
EVERY_LAYER = 1
"""The collision mask of all of a robot's shapes while they are checked against each other."""

Depths = dict[tuple[int, int], float]
"""Deepest overlap in m of two bodies, the robot's first."""


def report_overlaps(
    model: mujoco.MjModel,
    qpos: NDArray[np.float64],
    links: Mapping[str, int],
    self_collides: bool,
    report: BuildReport,
    advice: str = "",
) -> None:
    """Report the overlaps of one robot in the pose in which it starts.

    Args:
        model: the model; it is changed during the call and restored.
        qpos: starting positions, shape (nq,).
        links: the robot's bodies by name; body 0 is the world.
        self_collides: whether overlaps between the robot's own links were already reported.
        report: receives a warning for overlaps that push the robot, a note for the others.
        advice: what to do if the robot starts below the floor.
    """
    names = {body: name for name, body in links.items() if body}
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_fwdPosition(model, data)
    sunk: dict[int, float] = {}
    for (body, other), depth in _deepest(data, model, names, inside=False).items():
        if _is_floor(model, other):
            sunk[body] = max(sunk.get(body, 0.0), depth)
            continue
        where = f"inside '{model.body(other).name}'"
        message = f"it starts {_millimetres(depth)} {where}, and is pushed out with force"
        report.warn(f"link '{names[body]}'", message)
    if sunk:
        message = f"below the floor by {_each(sunk)}, and pushed out with force{advice}"
        report.warn(_quoted_links(sunk, names), message)
    bolted = dict(_sunk(model, data, names))
    if bolted:
        message = f"below the floor by {_each(bolted)}; bolted down, so nothing pushes"
        report.inform(_quoted_links(bolted, names), message)
    if self_collides:
        return
    for pair, depth in _own_overlaps(model, data, names).items():
        report.inform(
            _quoted_links(pair, names),
            f"they overlap by {_millimetres(depth)} at the start; links of one robot collide only "
            "with self_collide",
        )


def _quoted_links(bodies: Iterable[int], names: Mapping[int, str]) -> str:
    *others, last = [f"'{names[body]}'" for body in bodies]
    return f"links {', '.join(others)} and {last}" if others else f"link {last}"


def _each(depths: Mapping[int, float]) -> str:
    return ", ".join(map(_millimetres, depths.values()))


def _millimetres(depth_m: float) -> str:
    return f"{depth_m * 1000:.0f} mm"


def _deepest(
    data: mujoco.MjData, model: mujoco.MjModel, names: Mapping[int, str], inside: bool
) -> Depths:
    """Return the overlaps of a robot's bodies with each other, or with everything else."""
    depths: Depths = {}
    for contact in data.contact:
        pair = [int(model.geom_bodyid[geom]) for geom in contact.geom]
        if not names.keys() & set(pair) or (set(pair) <= names.keys()) is not inside:
            continue
        if contact.dist < -SHALLOW_M:
            body, other = pair if pair[0] in names else pair[::-1]
            depths[body, other] = max(depths.get((body, other), 0.0), -float(contact.dist))
    return depths


def _own_overlaps(model: mujoco.MjModel, data: mujoco.MjData, names: Mapping[int, str]) -> Depths:
    """Return the overlaps of the robot's own links, except pairs that a joint connects."""
    masks = (model.geom_contype, model.geom_conaffinity, model.body_contype, model.body_conaffinity)
    before = [mask.copy() for mask in masks]
    own = np.isin(model.geom_bodyid, list(names)) & ((before[0] | before[1]) != 0)
    for mask in masks[:2]:
        mask[:] = np.where(own, EVERY_LAYER, 0)
    for mask in masks[2:]:
        mask[:] = EVERY_LAYER
    try:
        mujoco.mj_collision(model, data)
        depths = _deepest(data, model, names, inside=True)
    finally:
        for mask, values in zip(masks, before, strict=True):
            mask[:] = values
    jointed = set(jointed_pairs(model, sorted(names)))
    return {pair: d for pair, d in depths.items() if (min(pair), max(pair)) not in jointed}


def _sunk(
    model: mujoco.MjModel, data: mujoco.MjData, names: Mapping[int, str]
) -> Iterator[tuple[int, float]]:
    """Yield the bolted-down bodies that extend below a level floor, and by how much in m."""
    floors = [
        float(data.geom_xpos[geom, 2])
        for geom in range(model.ngeom)
        if model.geom_type[geom] == PLANE
        and (model.geom_contype[geom] or model.geom_conaffinity[geom])
        and data.geom_xmat[geom, 8] > LEVEL
    ]
    if not floors:
        return
    depths: dict[int, float] = {}
    for root in {int(model.body_rootid[body]) for body in names}:
        for geom, height in lowest_points(model, data, root).items():
            body = int(model.geom_bodyid[geom])
            if model.body_weldid[body] == 0:
                depths[body] = max(depths.get(body, 0.0), max(floors) - height)
    yield from ((body, depth) for body, depth in depths.items() if depth > SHALLOW_M)


def _is_floor(model: mujoco.MjModel, body: int) -> bool:
    first, count = model.body_geomadr[body], model.body_geomnum[body]
    return bool((model.geom_type[first : first + count] == PLANE).any())
