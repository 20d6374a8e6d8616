"""An SDF model's bodies and planes in a MuJoCo specification."""

import mujoco
import numpy as np

from arm_description.robot import Pose
from arm_gazebo.build_report import BuildReport
from arm_gazebo.mesh.library import MeshLibrary
from arm_gazebo.quaternion import wxyz
from arm_gazebo.robot.body_tree import BodyTree, TreeOptions
from arm_gazebo.robot.collision_policy import WORLD_CONTYPE, CollisionMasks
from arm_gazebo.robot.link_geometry import (
    COLLISION_GROUP,
    DEFAULT_COLOR,
    VISUAL_GROUP,
    LinkGeometry,
)
from arm_gazebo.sdf.model import SdfModel, SdfPlane

WORLD_MASKS = CollisionMasks(WORLD_CONTYPE, WORLD_CONTYPE)


def add_model(
    spec: mujoco.MjSpec,
    meshes: MeshLibrary,
    model: SdfModel,
    pose: Pose,
    report: BuildReport,
    strict: bool = False,
) -> None:
    """Add a model to a world, its frame as a body of the model's name.

    Args:
        spec: the world.
        meshes: of the world.
        model: what to add.
        pose: of the model's frame in the world.
        report: gets what is repaired.
        strict: whether a mesh that cannot be had is an error.

    Raises:
        MeshError: strict, and a mesh cannot be had.
    """
    default = mujoco.MjSpec().default
    geometry = LinkGeometry(meshes, default, model.tags, WORLD_MASKS, strict, report)
    options = TreeOptions(spec.option.timestep, default, not model.static, pose)
    bodies = BodyTree(spec, model.robot, geometry, options, report).add()
    for plane in model.planes:
        add_plane(bodies[model.robot.name], plane)


def add_plane(body: mujoco.MjsBody, plane: SdfPlane) -> None:
    """Add a plane to a body that stands still."""
    geom = body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_PLANE, pos=plane.pose.xyz, quat=wxyz(plane.pose.rpy)
    )
    if plane.size is None:
        geom.size = [0.0, 0.0, 1.0]
        geom.group = COLLISION_GROUP
        if plane.friction is not None:
            geom.friction = [plane.friction, *geom.friction[1:]]
    else:
        geom.size = [*(np.array(plane.size) / 2), 1.0]
        geom.group = VISUAL_GROUP
        geom.contype = geom.conaffinity = 0
        geom.rgba = plane.rgba or DEFAULT_COLOR
