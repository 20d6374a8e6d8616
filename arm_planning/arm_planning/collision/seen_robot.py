"""Which points of a depth camera show the robot itself."""

import logging
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from arm_description.resources import ResourceFinder
from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.robot import Link
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.body_filter import BodyFilter
from arm_planning.collision.geoms import link_geoms
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.errors import PlanningError
from arm_planning.robot.build import planning_model
from arm_planning.robot.srdf import Srdf

PADDING_M = 0.01
_logger = logging.getLogger(__name__)


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
