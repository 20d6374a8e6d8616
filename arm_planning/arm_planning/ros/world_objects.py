"""The things of the simulated world as objects of the planning scene, moving ones too."""

from collections.abc import Collection, Iterable, Iterator, Mapping

import numpy as np
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message
from visualization_msgs.msg import Marker, MarkerArray

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.rigid_transform import RigidTransform
from arm_planning.scene.objects import CollisionObject
from arm_planning.scene.world_things import WorldSolid, objects_of_solids

TOPIC = "/world_markers"
DEPTH = 10
KINDS = {
    Marker.CUBE: "box",
    Marker.SPHERE: "ball",
    Marker.CYLINDER: "cylinder",
    Marker.TRIANGLE_LIST: "triangles",
}


class WorldObjects:
    """Reads the world's shapes as they are drawn; robots are not among them.

    One thread at a time.
    """

    def __init__(self, node: Node, robot: RigidTransform, links: Collection[str]) -> None:
        """Listen to the simulation; the robot's root is fixed at this pose in its world."""
        self._world, self._links = robot.inverse(), links
        self._polled = PolledSubscriptions(node)
        latched = QoSProfile(depth=DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._subscription = self._polled.subscribe(MarkerArray, TOPIC, latched)
        self._things: Mapping[str, CollisionObject] = {}

    def take(self) -> Mapping[str, CollisionObject]:
        """Return the things by their names; the same mapping until they have moved or changed."""
        heard = [raw for raw, _ in self._polled.take(self._subscription, DEPTH)]
        if heard:
            # Each message has all shapes.
            solids = solids_of(deserialize_message(heard[-1], MarkerArray).markers)
            self._things = objects_of_solids(solids, self._world, self._links)
        return self._things


def solids_of(markers: Iterable[Marker]) -> Iterator[WorldSolid]:
    """Yield the solids that markers show; the namespace of a marker is the thing's name."""
    for marker in markers:
        if marker.action != Marker.ADD or marker.type not in KINDS:
            continue
        position, rotation = marker.pose.position, marker.pose.orientation
        yield WorldSolid(
            marker.ns,
            KINDS[marker.type],
            (marker.scale.x, marker.scale.y, marker.scale.z),
            RigidTransform(
                (position.x, position.y, position.z),
                (rotation.x, rotation.y, rotation.z, rotation.w),
            ),
            np.array([(point.x, point.y, point.z) for point in marker.points]).reshape(-1, 3),
        )
