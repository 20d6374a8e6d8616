"""Where a link can be: places within the limits of the joints that carry it, as points."""

import math
from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray
from viser import PointCloudHandle, SceneApi

from arm_description.transforms import rotation_from_rpy
from arm_description.urdf.robot import Joint, Robot

SAMPLES = 40_000
CELLS = 26
"""Cells along the longest side; each has one point, so that what is far away is seen, too."""
POINT = 0.22
"""Size of a point, in cells."""
SELDOM, OFTEN = (196, 210, 255), (66, 46, 160)
Array = NDArray[np.float64]


def reachable_points(robot: Robot, link: str, samples: int = SAMPLES) -> Array:
    """Return places of a link's origin in the frame of the robot's root, shape (n, 3).

    The joints have random positions within their limits, the same in each call. What the link
    would touch there is not looked at.
    """
    chain = list(_chain(robot, link))
    rng = np.random.default_rng(0)
    leaders: dict[str, Array] = {}
    for joint in chain:
        leader = robot.leader_of(joint.name).joint
        if leader not in leaders:
            low, high = _range(robot.joint(leader))
            leaders[leader] = rng.uniform(low, high, samples)
    points = np.zeros((samples if leaders else 1, 3))
    for joint in reversed(chain):
        rule = robot.leader_of(joint.name)
        points = _moved(joint, rule.multiplier * leaders[rule.joint] + rule.offset, points)
    return points


def cells_of(points: Array) -> tuple[Array, NDArray[np.intp], float]:
    """Return the mean point of each cell (m, 3), how many points it has (m,), and its side in m."""
    side_m = max(float(np.ptp(points, axis=0).max()) / CELLS, 1e-3)
    _, cell, counts = np.unique(
        np.floor(points / side_m).astype(np.int64), axis=0, return_inverse=True, return_counts=True
    )
    sums = np.zeros((len(counts), 3))
    np.add.at(sums, cell.reshape(-1), points)
    return sums / counts[:, None], counts, side_m


class ReachCloud:
    """Draws the reach of one link; use it in viser's event loop."""

    def __init__(self, scene: SceneApi) -> None:
        """Draw into this scene."""
        self._scene = scene
        self._node: PointCloudHandle | None = None

    def show(self, robot: Robot, link: str, frame_path: str) -> None:
        """Draw the reach of a link below the node of the robot's root link."""
        self.hide()
        points, counts, side_m = cells_of(reachable_points(robot, link))
        share = (np.log(counts) / max(math.log(counts.max()), 1e-9))[:, None]
        colours = (1.0 - share) * np.array(SELDOM) + share * np.array(OFTEN)
        self._node = self._scene.add_point_cloud(
            f"{frame_path}/reach",
            points.astype(np.float32),
            colours.astype(np.uint8),
            point_size=POINT * side_m,
            point_shape="circle",
        )

    def hide(self) -> None:
        """Remove what is drawn."""
        if self._node is not None:
            self._node.remove()
            self._node = None


def _chain(robot: Robot, link: str) -> Iterator[Joint]:
    """Yield the joints from the root to a link, all of which have one degree of freedom or none."""
    carriers: Mapping[str, Joint] = {joint.child: joint for joint in robot.joints}
    above: list[Joint] = []
    while link in carriers:
        above.append(carriers[link])
        link = above[-1].parent
    yield from reversed(above)


def _range(joint: Joint) -> tuple[float, float]:
    if not joint.type.is_scalar:
        return 0.0, 0.0
    limit = joint.limit
    if limit is not None and -math.inf < limit.lower < limit.upper < math.inf:
        return limit.lower, limit.upper
    return (-math.pi, math.pi) if joint.type.turns else (0.0, 0.0)


def _moved(joint: Joint, positions: Array, points: Array) -> Array:
    """Return points (n, 3) of a child link in its parent, at the joint's positions (n,)."""
    if joint.type.is_scalar:
        axis, value = np.array(joint.axis), positions[:, None]
        if joint.type.turns:
            along = (points @ axis)[:, None] * axis
            aside = np.cross(axis, points)
            points = along + (points - along) * np.cos(value) + aside * np.sin(value)
        else:
            points = points + axis * value
    return points @ rotation_from_rpy(joint.origin.rpy).T + np.array(joint.origin.xyz)
