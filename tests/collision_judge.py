"""An independent judge of collisions: python-fcl, on `forward_kinematics`."""

from collections.abc import Mapping
from itertools import combinations

import fcl
import numpy as np

from arm_description import forward_kinematics
from arm_description.urdf.robot import Box, Capsule, Cylinder, Sphere
from arm_planning.robot.model import PlanningModel
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import Cone, Plane, TriangleMesh


class Judge:
    """Says whether a state is free; for scenes without padding and meshes of links.

    A mesh is a surface here, so a link that is wholly inside of one is free.
    """

    def __init__(self, model: PlanningModel, scene: PlanningScene) -> None:
        self._robot = model.robot
        self._allowed = scene.allowed
        self._parts: list[tuple[str, str, np.ndarray, fcl.CollisionObject]] = []
        for link in model.robot.links:
            for shape in link.collisions:
                self._add(link.name, link.name, shape.origin.matrix(), shape.geometry)
        for body in scene.attached.values():
            for placed in body.object.shapes:
                pose = np.array(body.object.pose.then(placed.pose).matrix())
                self._add(body.object.id, body.link, pose, placed.shape)
        self._touch = {
            name: {body.link, *body.touch_links} for name, body in scene.attached.items()
        }
        world = [
            (thing.id, fcl.CollisionObject(geometry(placed.shape), at(pose)))
            for thing in scene.objects.values()
            for placed in thing.shapes
            for pose in [np.array(thing.pose.then(placed.pose).matrix())]
        ]
        self._pairs = [
            (a, b)
            for (first, _, _, a), (second, _, _, b) in combinations(self._parts, 2)
            if first != second and not self._may_touch(first, second)
        ]
        self._pairs += [
            (a, b)
            for name, _, _, a in self._parts
            for other, b in world
            if not self._may_touch(name, other)
        ]

    def is_free(self, positions: Mapping[str, float]) -> bool:
        """Whether nothing collides; positions by joint."""
        poses = forward_kinematics(self._robot, positions)
        for _, link, pose, thing in self._parts:
            thing.setTransform(at(poses[link] @ pose))
        request = fcl.CollisionRequest()
        return not any(fcl.collide(a, b, request, fcl.CollisionResult()) for a, b in self._pairs)

    def _may_touch(self, first: str, second: str) -> bool:
        return (
            self._allowed.may_touch(first, second)
            or second in self._touch.get(first, ())
            or first in self._touch.get(second, ())
        )

    def _add(self, name: str, link: str, pose: np.ndarray, shape: object) -> None:
        self._parts.append((name, link, pose, fcl.CollisionObject(geometry(shape))))


def at(pose: np.ndarray) -> fcl.Transform:
    return fcl.Transform(pose[:3, :3], pose[:3, 3])


def geometry(shape: object) -> fcl.CollisionGeometry:
    match shape:
        case Box((x, y, z)):
            return fcl.Box(x, y, z)
        case Sphere(radius):
            return fcl.Sphere(radius)
        case Cylinder(radius, length):
            return fcl.Cylinder(radius, length)
        case Capsule(radius, length):
            return fcl.Capsule(radius, length)
        case Cone(radius, height):
            return fcl.Cone(radius, height)
        case Plane(a, b, c, d):
            length = float(np.linalg.norm((a, b, c)))
            return fcl.Halfspace(np.array([a, b, c]) / length, -d / length)
        case TriangleMesh():
            mesh = fcl.BVHModel()
            mesh.beginModel(len(shape.triangles), len(shape.vertices))
            mesh.addSubModel(shape.vertices, shape.triangles)
            mesh.endModel()
            return mesh
    raise NotImplementedError(shape)
