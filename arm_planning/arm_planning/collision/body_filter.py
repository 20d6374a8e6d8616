"""Which points are on or in bodies: a robot's links, and what is attached to it or in the scene.

So it is known which points of a depth camera show the robot itself.
"""

import logging
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from operator import itemgetter

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.resources import ResourceFinder
from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.robot import Link
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.geoms import Geom, link_geoms, object_geoms
from arm_planning.collision.mesh_pieces import Hull, MeshPieces, convex_hull
from arm_planning.errors import PlanningError
from arm_planning.robot.build import planning_model
from arm_planning.robot.model import PlanningModel
from arm_planning.robot.srdf import Srdf
from arm_planning.scene.frames import LinkPoses
from arm_planning.scene.scene import PlanningScene

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Body = tuple[RigidTransform, tuple[Geom, ...]]
Ball = tuple[Array, float]
MOST_HULLS = 500
PADDING_M = 0.01
_logger = logging.getLogger(__name__)


class BodyFilter:
    """Tells which points belong to what the scene knows; not thread-safe.

    Args:
        model: the robot.
        meshes: cuts meshes.
        scale: factor of each shape about its middle.
        padding_m: by which each shape is grown then.
    """

    def __init__(
        self, model: PlanningModel, meshes: MeshPieces, scale: float, padding_m: float
    ) -> None:
        self._model, self._meshes = model, meshes
        self._scale, self._padding_m = scale, padding_m
        self._hulls: dict[int, tuple[Array, Hull]] = {}

    def inside(self, points: Array, scene: PlanningScene) -> Mask:
        """Return which points (n, 3) in the planning frame are in a link or an object, (n,).

        Raises:
            PlanningError: a shape cannot be used.
        """
        links = LinkPoses(self._model, scene.positions)
        found = self.in_links(points, links.__getitem__)
        return self._add(found, points, self._others(scene, links))

    def in_links(self, points: Array, pose_of: Callable[[str], RigidTransform | None]) -> Mask:
        """Return which points (n, 3) are in the robot's links, (n,).

        Args:
            points: in any frame.
            pose_of: gives a link's pose in that frame; a link without one is left out.

        Raises:
            PlanningError: a shape cannot be used.
        """
        bodies = (
            (pose, link_geoms(link, self._meshes))
            for link in self._model.robot.links
            if link.collisions and (pose := pose_of(link.name)) is not None
        )
        return self._add(np.zeros(len(points), bool), points, bodies)

    def _add(self, found: Mask, points: Array, bodies: Iterable[Body]) -> Mask:
        """Return which points have been found or are in one of the bodies."""
        columns = np.ascontiguousarray(points.T)
        for pose, geoms in filter(itemgetter(1), bodies):
            placed = [np.array(_placed(pose, geom).matrix()) for geom in geoms]
            balls = [self._ball(*one) for one in zip(geoms, placed, strict=True)]
            rest = np.flatnonzero(_near(columns, _around(balls)) & ~found)
            some, within = columns[:, rest], np.zeros(len(rest), bool)
            for geom, matrix, ball in zip(geoms, placed, balls, strict=True):
                near = np.flatnonzero(_near(some, ball) & ~within)
                local = (some[:, near].T - matrix[:3, 3]) @ matrix[:3, :3]
                within[near] = self._in_shape(geom, local)
            found[rest[within]] = True
        return found

    def _others(self, scene: PlanningScene, links: LinkPoses) -> Iterable[Body]:
        for body in scene.attached.values():
            pose = links[body.link].then(body.object.pose)
            yield pose, object_geoms(body.object, self._meshes)
        for thing in scene.objects.values():
            yield thing.pose, object_geoms(thing, self._meshes)

    def _ball(self, geom: Geom, matrix: Array) -> Ball:
        """Return the middle and the radius of a ball about a shape at a place."""
        if geom.type == mujoco.mjtGeom.mjGEOM_PLANE:
            return matrix[:3, 3], np.inf
        if geom.corners is None:
            middle, radius = np.zeros(3), float(np.linalg.norm(geom.size))
            if geom.type == mujoco.mjtGeom.mjGEOM_CAPSULE:
                radius = geom.size[0] + geom.size[1]
        else:
            middle = geom.corners.mean(axis=0)
            radius = float(np.linalg.norm(geom.corners - middle, axis=1).max())
        reach = self._scale * radius + 2 * self._padding_m
        return matrix[:3, :3] @ middle + matrix[:3, 3], reach

    def _in_shape(self, geom: Geom, local: Array) -> Mask:
        x, y, z = self._scale * np.array(geom.size) + self._padding_m
        match geom.type:
            case mujoco.mjtGeom.mjGEOM_BOX:
                return np.asarray((np.abs(local) <= (x, y, z)).all(axis=1))
            case mujoco.mjtGeom.mjGEOM_SPHERE:
                return (local**2).sum(axis=1) <= x**2
            case mujoco.mjtGeom.mjGEOM_CYLINDER:
                return (np.hypot(*local[:, :2].T) <= x) & (np.abs(local[:, 2]) <= y)
            case mujoco.mjtGeom.mjGEOM_CAPSULE:
                half = self._scale * geom.size[1]
                beyond = np.maximum(np.abs(local[:, 2]) - half, 0.0)
                return (local[:, :2] ** 2).sum(axis=1) + beyond**2 <= x**2
            case mujoco.mjtGeom.mjGEOM_PLANE:
                return local[:, 2] <= self._padding_m
            case _:
                hull = self._hull(geom)
                middle = hull.normals @ hull.corners.mean(axis=0)
                heights = middle + self._scale * (hull.heights - middle) + self._padding_m
                return np.asarray((local @ hull.normals.T <= heights).all(axis=1))

    def _hull(self, geom: Geom) -> Hull:
        corners = geom.corners
        assert corners is not None
        if id(corners) not in self._hulls:
            if len(self._hulls) >= MOST_HULLS:
                self._hulls.pop(next(iter(self._hulls)))
            # The corners are kept, so that no other array gets their id.
            self._hulls[id(corners)] = (corners, convex_hull(corners))
        return self._hulls[id(corners)][1]


def _placed(pose: RigidTransform, geom: Geom) -> RigidTransform:
    position, (w, x, y, z) = geom.placement
    return pose.then(RigidTransform(position, (x, y, z, w)))


def _around(balls: Sequence[Ball]) -> Ball:
    """Return a ball around others."""
    middle = np.mean([middle for middle, _ in balls], axis=0)
    return middle, max(float(np.linalg.norm(each - middle)) + radius for each, radius in balls)


def _near(columns: Array, ball: Ball) -> Mask:
    """Return which points (3, n) are in a ball, (n,)."""
    (x, y, z), radius = ball
    return (columns[0] - x) ** 2 + (columns[1] - y) ** 2 + (columns[2] - z) ** 2 <= radius**2


class SeenRobot:
    """Finds a robot's links in a picture, by what they look like and what they collide with.

    Collision shapes are often smaller than what a camera sees. Not thread-safe.
    """

    def __init__(self, urdf: str, padding_m: float = PADDING_M) -> None:
        """Read the robot and its meshes; what it looks like is left out where it cannot be used.

        Args:
            urdf: the robot's text.
            padding_m: by which each shape is grown.

        Raises:
            DescriptionError: the URDF cannot be used.
            PlanningError: a collision shape cannot be used.
        """
        meshes = MeshPieces(ResourceFinder.of_description(urdf))
        robot = parse_urdf(urdf)
        robot = replace(robot, links=tuple(_as_seen(link, meshes) for link in robot.links))
        model = planning_model(robot, Srdf(robot.name), warn=_logger.debug)
        self._bodies = BodyFilter(model, meshes, 1.0, padding_m)

    def pixels(
        self, points: NDArray[np.float32], pose_of: Callable[[str], RigidTransform | None]
    ) -> NDArray[np.bool_]:
        """Return which pixels show the robot, (height, width).

        Args:
            points: (height, width, 3) in m, nan where nothing is seen.
            pose_of: gives a link's pose in the points' frame; a link without one is left out.
        """
        seen = np.isfinite(points[..., 2])
        shown = np.zeros(seen.shape, bool)
        shown[seen] = self._bodies.in_links(points[seen].astype(np.float64), pose_of)
        return shown


def _as_seen(link: Link, meshes: MeshPieces) -> Link:
    """Return a link that collides with what it looks like, too."""
    link_geoms(link, meshes)
    seen = replace(link, collisions=(*link.collisions, *link.visuals))
    try:
        link_geoms(seen, meshes)
    except PlanningError as error:
        _logger.warning("what the camera sees of it is taken from its collision shapes: %s", error)
        return link
    return seen
