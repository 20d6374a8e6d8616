"""Add an SDF model's bodies and planes to a MuJoCo specification."""

from dataclasses import replace

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.transforms import wxyz_from_rpy
from arm_description.urdf.robot import Link, Pose, Robot
from arm_gazebo.build_report import BuildOutcome, BuildReport
from arm_gazebo.mesh.library import MeshLibrary
from arm_gazebo.robot.body_tree import BodyTree, TreeOptions
from arm_gazebo.robot.collision_policy import WORLD_CONTYPE, CollisionMasks
from arm_gazebo.robot.gazebo_tags import GazeboTags
from arm_gazebo.robot.link_geometry import (
    COLLISION_GROUP,
    DEFAULT_COLOR,
    VISUAL_GROUP,
    LinkGeometry,
    set_friction,
)
from arm_gazebo.sdf.auto_inertia import auto_inertial
from arm_gazebo.sdf.model import DEFAULT_INERTIAL, SdfModel, SdfPlane

WORLD_MASKS = CollisionMasks(WORLD_CONTYPE, WORLD_CONTYPE)


def add_model(
    spec: mujoco.MjSpec,
    meshes: MeshLibrary,
    model: SdfModel,
    pose: NDArray[np.float64],
    report: BuildReport,
    strict: bool = False,
) -> None:
    """Add a rigid body of a model to a world; its frame becomes a body of the same name.

    The pose (4, 4) of the model's frame is in the world; `strict` makes an unavailable mesh an
    error.

    Raises:
        MeshError: a mesh is unavailable and `strict` is set.
    """
    default = mujoco.MjSpec().default
    geometry = _SdfGeometry(model, meshes, strict, report)
    place = Pose.of(pose @ model.frame)
    options = TreeOptions(spec.option.timestep, default, not model.static, place, model.weightless)
    robot = model.robot if model.static else _with_inertia(model, meshes, report)
    bodies = BodyTree(spec, robot, geometry, options, report).add()
    for plane in model.planes:
        add_plane(bodies[model.robot.name], plane)


def _with_inertia(model: SdfModel, meshes: MeshLibrary, report: BuildReport) -> Robot:
    """Return a model's robot with its automatic inertias computed."""
    links: list[Link] = []
    for link in model.robot.links:
        auto = model.automatic.get(link.name)
        inertial = auto_inertial(link, auto, meshes) if auto else link.inertial
        if auto and inertial is None:
            inertial = DEFAULT_INERTIAL
            report.repair(
                f"link '{link.name}'",
                "its automatic inertia needs a collision with a volume, and it has none; 1 kg and "
                "1 kg m2 are used",
                link.line,
            )
        links.append(replace(link, inertial=inertial))
    return replace(model.robot, links=tuple(links))


def add_plane(body: mujoco.MjsBody, plane: SdfPlane) -> None:
    """Add a plane to a static body."""
    geom = body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_PLANE, pos=plane.pose.xyz, quat=wxyz_from_rpy(plane.pose.rpy)
    )
    if plane.size is None:
        geom.size = [0.0, 0.0, 1.0]
        geom.group = COLLISION_GROUP
        set_friction(geom, plane.friction)
    else:
        geom.size = [*(np.array(plane.size) / 2), 1.0]
        geom.group = VISUAL_GROUP
        geom.contype = geom.conaffinity = 0
        geom.rgba = plane.rgba or DEFAULT_COLOR


class _SdfGeometry(LinkGeometry):
    """Adds the shapes of links, with a separate friction for each collision."""

    missing = BuildOutcome.LEFT_OUT

    def __init__(
        self, model: SdfModel, meshes: MeshLibrary, strict: bool, report: BuildReport
    ) -> None:
        default = mujoco.MjSpec().default
        super().__init__(meshes, default, GazeboTags(), WORLD_MASKS, strict, report)
        self._frictions = model.frictions

    def add(self, body: mujoco.MjsBody, link: Link) -> None:
        """Add the visuals and collisions of a link to its body."""
        super().add(body, replace(link, collisions=()))
        frictions = self._frictions.get(link.name, ())
        for collision, friction in zip(link.collisions, frictions, strict=True):
            before = len(body.geoms)
            super().add(body, replace(link, visuals=(), collisions=(collision,)))
            for geom in body.geoms[before:]:
                set_friction(geom, friction)
