"""The things of the simulated world as objects of the planning scene, moving ones too."""

from collections.abc import Callable, Mapping

import numpy as np
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message
from visualization_msgs.msg import Marker, MarkerArray

from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.rigid_transform import RigidTransform
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.shapes import Shape, TriangleMesh

TOPIC = "/world_markers"
DEPTH = 10
EXACT_M = 1e-5
"""Corners of triangles that are nearer than this are one."""


class WorldObjects:
    """Reads the world's shapes as they are drawn; robots are not among them.

    One thread at a time.
    """

    def __init__(self, node: Node, frame: Callable[[str], RigidTransform | None]) -> None:
        """Listen to the simulation.

        Args:
            node: has the subscription.
            frame: returns a frame's pose in the planning frame, None as long as it is unknown.
        """
        self._frame = frame
        self._polled = PolledSubscriptions(node)
        latched = QoSProfile(depth=DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._subscription = self._polled.subscribe(MarkerArray, TOPIC, latched)
        self._waiting: MarkerArray | None = None

    def take(self) -> Mapping[str, CollisionObject] | None:
        """Return the things by their names, if they have moved or changed since the last call."""
        for raw, _ in self._polled.take(self._subscription, DEPTH):
            # Each message has all shapes.
            self._waiting = deserialize_message(raw, MarkerArray)
        if self._waiting is None:
            return None
        world = self._frame("world")
        if world is None:
            return None
        markers = [each for each in self._waiting.markers if each.action == Marker.ADD]
        self._waiting = None
        return objects_of(markers, world)


def objects_of(markers: list[Marker], world: RigidTransform) -> dict[str, CollisionObject]:
    """Return an object for each thing; it stands where its first shape stands.

    Args:
        markers: the shapes; the namespace of a marker is the thing's name.
        world: the world's frame in the planning frame.
    """
    shapes: dict[str, list[PlacedShape]] = {}
    for marker in markers:
        shape = _shape(marker)
        if shape is not None:
            shapes.setdefault(marker.ns, []).append(PlacedShape(shape, world.then(_pose(marker))))
    objects: dict[str, CollisionObject] = {}
    for name, placed in shapes.items():
        origin = placed[0].pose
        inside = tuple(PlacedShape(each.shape, origin.inverse().then(each.pose)) for each in placed)
        objects[name] = CollisionObject(name, origin, inside)
    return objects


def _shape(marker: Marker) -> Shape | None:
    x, y, z = marker.scale.x, marker.scale.y, marker.scale.z
    match marker.type:
        case Marker.CUBE:
            return Box((x, y, z))
        case Marker.SPHERE:
            # An ellipsoid is inside of the ball about it.
            return Sphere(max(x, y, z) / 2.0)
        case Marker.CYLINDER:
            return Cylinder(radius=max(x, y) / 2.0, length=z)
        case Marker.TRIANGLE_LIST:
            corners = np.array([(point.x, point.y, point.z) for point in marker.points])
            if not len(corners):
                return None
            rounded = np.round(corners / EXACT_M)
            _, first, index = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
            triangles = index.reshape(-1, 3)
            whole = (np.diff(np.sort(triangles, axis=1), axis=1) > 0).all(axis=1)
            return TriangleMesh(corners[first], triangles[whole].astype(np.int64))
        case _:
            return None


def _pose(marker: Marker) -> RigidTransform:
    position, rotation = marker.pose.position, marker.pose.orientation
    return RigidTransform(
        (position.x, position.y, position.z), (rotation.x, rotation.y, rotation.z, rotation.w)
    )
