"""Which shapes collide: Gazebo's defaults in MuJoCo's terms; and what overlaps from the start."""

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from itertools import combinations

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_gazebo.build_report import BuildReport
from arm_gazebo.robot.floor_contact import lowest_points, touching_geoms
from arm_node.frozen import frozen

WORLD_CONTYPE = 1
"""MuJoCo's default for a geom, so that every world file works unchanged."""


@frozen
class CollisionMasks:
    """MuJoCo's two bit masks: two shapes collide if the type of one is in the other's affinity."""

    contype: int
    conaffinity: int


MAX_LAYERS = 30
"""A mask has 32 bits. The world uses one, and the sign bit is not usable."""


@frozen
class CollisionLayer:
    """The robot that a shape belongs to, by index; it collides with the world and other robots."""

    index: int = 0
    count: int = 1

    def masks(self, self_collide: bool) -> CollisionMasks:
        """Return the masks of the robot's shapes; with `self_collide` they touch each other too."""
        own = 2 << self.index
        others = sum(2 << index for index in range(self.count)) - own
        return CollisionMasks(own, WORLD_CONTYPE | others | (own if self_collide else 0))


def with_self(masks: CollisionMasks) -> CollisionMasks:
    """Return masks that also collide with shapes of the same robot."""
    return CollisionMasks(masks.contype, masks.conaffinity | masks.contype)


def exclude_own_contacts(spec: mujoco.MjSpec, touching: Container[str]) -> None:
    """Exclude contacts between the bodies of one entity.

    `spec` has only the entity, with named bodies; those in `touching` still collide with all
    others.
    """
    solid = [
        (body.name, _carrier(body))
        for body in spec.bodies[1:]
        if any(geom.contype or geom.conaffinity for geom in body.geoms)
        and body.name not in touching
    ]
    for (first, carrier), (second, other_carrier) in combinations(solid, 2):
        # MuJoCo itself excludes bodies that are fixed to each other.
        if carrier != other_carrier:
            spec.add_exclude(bodyname1=first, bodyname2=second)


def _carrier(body: mujoco.MjsBody) -> str:
    """Return the name of the moving body, or the world, that a body is fixed to."""
    while not body.joints and body.parent is not None:
        body = body.parent
    return str(body.name)


def exclude_neighbour_contacts(
    spec: mujoco.MjSpec,
    model: mujoco.MjModel,
    qpos: NDArray[np.float64],
    links: Sequence[str],
    report: BuildReport,
) -> None:
    """Exclude contacts between links that a joint connects, and links that overlap at the start.

    Args:
        spec: receives the exclusions.
        model: compiled from `spec` without the exclusions.
        qpos: starting positions, shape (nq,).
        links: names of the robot's bodies.
        report: receives a warning for each overlapping pair.
    """
    bodies = {model.body(name).id: name for name in links}
    jointed = set(jointed_pairs(model, sorted(bodies)))
    depths = _deepest(_at_start(model, qpos), model, bodies, inside=True, beyond_m=0.0)
    overlapping = depths.keys() - jointed
    for first, second in sorted(jointed | overlapping):
        spec.add_exclude(bodyname1=bodies[first], bodyname2=bodies[second])
    for first, second in sorted(overlapping):
        report.warn(
            f"links '{bodies[first]}' and '{bodies[second]}'",
            f"they overlap by {depths[first, second] * 1000:.3g} mm in the starting pose; they "
            "will not collide with each other",
        )


def jointed_pairs(model: mujoco.MjModel, bodies: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Yield the pairs of bodies that one joint connects, including bodies fixed to either side.

    MuJoCo itself excludes parent and child, but not if the parent is fixed to the world.
    """
    weld = model.body_weldid
    for first, second in combinations(bodies, 2):
        one, other = weld[first], weld[second]
        above, above_other = weld[model.body_parentid[one]], weld[model.body_parentid[other]]
        if one != other and (above == other or above_other == one):
            yield first, second


def _at_start(model: mujoco.MjModel, qpos: NDArray[np.float64]) -> mujoco.MjData:
    """Return the state with these positions, with its contacts."""
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_fwdPosition(model, data)
    return data


PLANE = mujoco.mjtGeom.mjGEOM_PLANE
LEVEL = 1.0 - 1e-9
SHALLOW_M = 1e-3
"""Overlaps up to this are rounding errors of a mesh, or of a foot on the floor."""
LISTED = 4
"""Links that a finding names; of more, the first ones."""
EVERY_LAYER = 1
"""The collision mask of all of a robot's shapes while they are checked against each other."""

Depths = dict[tuple[int, int], float]
"""The deepest overlap of two bodies, in m. The robot's comes first; of two, the lower number."""


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
    data = _at_start(model, qpos)
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
    quoted = [f"'{names[body]}'" for body in bodies]
    if len(quoted) > LISTED:
        quoted = [*quoted[: LISTED - 1], f"{len(quoted) - LISTED + 1} more"]
    *others, last = quoted
    return f"links {', '.join(others)} and {last}" if others else f"link {last}"


def _each(depths: Mapping[int, float]) -> str:
    if len(depths) > LISTED:
        return f"up to {_millimetres(max(depths.values()))}"
    return ", ".join(map(_millimetres, depths.values()))


def _millimetres(depth_m: float) -> str:
    return f"{depth_m * 1000:.0f} mm"


def _deepest(
    data: mujoco.MjData,
    model: mujoco.MjModel,
    bodies: Container[int],
    inside: bool,
    beyond_m: float = SHALLOW_M,
) -> Depths:
    """Return the overlaps of a robot's bodies with each other, or with everything else."""
    depths: Depths = {}
    if not data.ncon:
        return depths
    pairs = model.geom_bodyid[data.contact.geom].tolist()
    for pair, distance in zip(pairs, data.contact.dist.tolist(), strict=True):
        body, other = sorted(pair, key=lambda number: (number not in bodies, number))
        if body not in bodies or (other in bodies) is not inside:
            continue
        if distance < -beyond_m:
            depths[body, other] = max(depths.get((body, other), 0.0), -distance)
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
    jointed = set(jointed_pairs(model, sorted(names))) if depths else ()
    return {pair: depth for pair, depth in depths.items() if pair not in jointed}


def _sunk(
    model: mujoco.MjModel, data: mujoco.MjData, names: Mapping[int, str]
) -> Iterator[tuple[int, float]]:
    """Yield the bolted-down bodies that extend below a level floor, and by how much in m."""
    touching = (model.geom_contype | model.geom_conaffinity) != 0
    level = (model.geom_type == PLANE) & touching & (data.geom_xmat[:, 8] > LEVEL)
    if not level.any():
        return
    floor = float(data.geom_xpos[level, 2].max())
    depths: dict[int, float] = {}
    bolted = np.zeros(model.nbody, bool)
    bolted[[*names]] = model.body_weldid[[*names]] == 0
    for geom, height in lowest_points(model, data, touching_geoms(model, bolted)).items():
        body = int(model.geom_bodyid[geom])
        depths[body] = max(depths.get(body, 0.0), floor - height)
    yield from ((body, depth) for body, depth in depths.items() if depth > SHALLOW_M)


def _is_floor(model: mujoco.MjModel, body: int) -> bool:
    first, count = model.body_geomadr[body], model.body_geomnum[body]
    return bool((model.geom_type[first : first + count] == PLANE).any())
