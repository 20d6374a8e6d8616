"""What a view tells of a thing's footprint: walls, the rim of its top, its left and right edge."""

from math import cos, hypot, sin

import numpy as np

from arm_planning.perception.footprints import OutlineEvidence
from arm_planning.perception.view import Array, Mask, PlaneView, Window

SAMPLES = 200
"""Most points of the walls and of the rim: more cost time and add little."""
WALL_FLOOR_M = 0.0003
"""Least standard deviation of a wall's point."""
RIM_PIXELS, EDGE_PIXELS = 0.35, 0.15
"""Standard deviations of where a top's outline and an edge are, in pixels."""
EDGE_SAMPLES = 5
"""Least pixels from which the direction of an edge is taken."""
FLATTEST, STEEPEST = 0.02, 1.5
"""Slopes of the line of sight: below it a top is not seen, above it edges are not."""
COVERING_PIXELS = 3
"""Pixels of nearer things along the outline from which on a thing counts as covered."""
STEP_M = 0.003
"""Least step in depth that counts, beside the noise's."""
GOING_ON_M = 0.03
"""Step in depth up to which something shapeless may be the same thing."""
NEIGHBOURS = ((0, 1), (0, -1), (1, 0), (-1, 0))


def evidence_of(
    view: PlaneView, window: Window, own: Mask, top: Mask, level: float, others: Mask
) -> tuple[OutlineEvidence, bool]:
    """Return what is seen of a thing, and whether something, or the picture's edge, cuts it off.

    Something nearer does, and so does what is `apart` where the thing may go on in it.

    Args:
        view: the view.
        window: a part of it, with at least one pixel around the thing.
        own: the thing's pixels.
        top: those of them that are its top.
        level: height of the top above the plane, in m.
        others: pixels of other things.
    """
    depths, rays = view.depths[window], view.rays[window]
    distance = float(np.median(depths[own]))
    noise = view.noise(distance)
    step = STEP_M + 3 * noise
    outside, apart = view.outside[window], view.apart[window]
    centre = view.spots(window, own).mean(axis=0)
    steepness = max(view.steepness(centre, level), FLATTEST)
    size = view.pixel * distance
    # As far as neighbours on a level top are apart in depth.
    going_on = step + size * hypot(1, 1 / steepness)
    cut, covering = False, 0
    rims: list[Array] = []
    edges: list[Array] = []
    for rows, columns in NEIGHBOURS:
        here = np.nonzero(own & ~np.roll(own, (-rows, -columns), (0, 1)))
        there = (here[0] + rows, here[1] + columns)
        cut |= bool(outside[there].any())
        farther = depths[there] - depths[here]
        covered = (others[there] & (farther < -step)) | (apart[there] & (farther < going_on))
        covering += int(covered.sum())
        # The outline is between the thing's outermost pixel and its neighbour.
        between = (0.5 * (rays[here] + rays[there])).astype(np.float64)
        rims.append(view.on_level(between[top[here] & ~covered], level))
        # Without a point behind it the gap is nan: then the background is far away.
        edges.append(between[~top[here] & ~(farther < step), :2])
    rim = _some(np.concatenate(rims))
    wall = own & ~top & (view.heights[window] < level - 2 * view.level_noise(distance, level))
    walls = _some(view.spots(window, wall))
    evidence = OutlineEvidence(
        walls=walls,
        wall_noise=noise / hypot(1, steepness) + WALL_FLOOR_M,
        rim=rim,
        rim_noise=RIM_PIXELS * size * hypot(1, 1 / steepness),
        edges=_edges(np.concatenate(edges), centre) if steepness < STEEPEST else np.empty((0, 2)),
        edge_noise=EDGE_PIXELS * size,
    )
    return evidence, cut or covering >= COVERING_PIXELS


def goes_on(view: PlaneView, window: Window, own: Mask, shapeless: Mask) -> bool:
    """Return whether what is seen of a thing goes on in what is neither a box nor a cylinder."""
    depths = view.depths[window]
    for rows, columns in NEIGHBOURS:
        here = np.nonzero(own & ~np.roll(own, (-rows, -columns), (0, 1)))
        there = (here[0] + rows, here[1] + columns)
        steps = np.abs(depths[there] - depths[here])
        if (shapeless[there] & (steps < GOING_ON_M)).any():
            return True
    return False


def _some(points: Array) -> Array:
    return points[:: max(1, len(points) // SAMPLES)]


def _edges(rays: Array, centre: Array) -> Array:
    """Return the lines of the left and the right edge, as `OutlineEvidence` has them."""
    c, s = centre / max(hypot(*centre), 1e-9)
    turns = np.arctan2(c * rays[:, 1] - s * rays[:, 0], c * rays[:, 0] + s * rays[:, 1])
    normals: list[Array] = []
    for side in (1, -1):
        outer = turns[side * turns > 0]
        if len(outer) >= EDGE_SAMPLES:
            turn = float(np.median(outer))
            ahead = np.array([c * cos(turn) - s * sin(turn), s * cos(turn) + c * sin(turn)])
            normals.append(side * np.array([-ahead[1], ahead[0]]))
    return np.array(normals).reshape(-1, 2)
