"""Publishes the world's shapes on /world_markers, for RViz and for the browser page."""

import math

import numpy as np
from geometry_msgs.msg import Point, Vector3
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.event_handler import PublisherEventCallbacks, QoSPublisherMatchedInfo
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from arm_gazebo.world.entity import WORLD_FRAME
from arm_gazebo.world.keeper import WorldKeeper
from arm_gazebo.world.shapes import Solid, WorldShape, WorldShapes
from arm_node.message_template import MessageTemplate

TOPIC = "world_markers"
QOS = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
PERIOD_S = 0.1
MOVED = 1e-4
"""Change of a coordinate, in m or of a quaternion, from which on a shape has moved."""
TYPES = {
    Solid.BOX: Marker.CUBE,
    Solid.BALL: Marker.SPHERE,
    Solid.CYLINDER: Marker.CYLINDER,
    Solid.TRIANGLES: Marker.TRIANGLE_LIST,
}
MOST_GONE = 1000
"""Deleted shapes that are told on and on: a message may be lost where a newer one follows."""


class WorldMarkerPublisher:
    """Looks ten times a second, while somebody listens, whether something moved.

    Every message has all shapes, so that the last one is enough for whoever comes late. It is
    serialised once for each model; then only the poses in its bytes change. The thread of the
    node's executor, which is the keeper's: it sleeps on while nobody listens.
    """

    def __init__(self, node: Node, keeper: WorldKeeper) -> None:
        self._keeper = keeper
        self._timer = node.create_timer(
            PERIOD_S, self._look, clock=Clock(clock_type=ClockType.STEADY_TIME)
        )
        self._timer.cancel()
        self._publisher = node.create_publisher(
            MarkerArray, TOPIC, QOS, event_callbacks=PublisherEventCallbacks(matched=self._match)
        )
        self._awaited = False
        self._model: object = None
        self._shown: dict[tuple[str, int], None] = {}
        self._gone: dict[tuple[str, int], None] = {}

    def _match(self, matched: QoSPublisherMatchedInfo) -> None:
        if not matched.current_count:
            self._timer.cancel()
        elif matched.current_count_change > 0:
            self._awaited = True
            self._timer.reset()

    def _look(self) -> None:
        if self._model is not self._keeper.model:
            self._take_model()
        poses = self._shapes.poses(*self._keeper.motions().geom_poses)
        if self._awaited or not np.abs(poses - self._poses).max(initial=0.0) < MOVED:
            self._poses = poses
            self._template.float64[self._places] = poses.ravel()
            self._template.publish(self._publisher)
            self._awaited = False

    def _take_model(self) -> None:
        self._model = self._keeper.model
        self._shapes = WorldShapes(self._keeper.model, self._keeper.entities)
        shown = dict.fromkeys(shape.key for shape in self._shapes.shapes)
        gone = {**self._gone, **self._shown}
        self._gone = dict.fromkeys([key for key in gone if key not in shown][-MOST_GONE:])
        self._shown = shown
        markers = [_marker(shape) for shape in self._shapes.shapes]
        gone_markers = [_deletion(owner, number) for owner, number in self._gone]
        self._template = MessageTemplate(MarkerArray(markers=[*markers, *gone_markers]))
        places = self._template.indices("markers[*].pose")
        self._places = places[: 7 * len(markers)]
        # Not a number: whatever is compared with it has moved.
        self._poses = np.full((len(markers), 7), math.nan)


def _marker(shape: WorldShape) -> Marker:
    r, g, b, a = shape.rgba
    x, y, z = shape.size
    marker = _empty(shape.owner, shape.number, Marker.ADD)
    marker.type = TYPES[shape.solid]
    marker.scale = Vector3(x=x, y=y, z=z)
    marker.color = ColorRGBA(r=r, g=g, b=b, a=a)
    marker.points = [Point(x=px, y=py, z=pz) for px, py, pz in shape.corners.tolist()]
    return marker


def _deletion(owner: str, number: int) -> Marker:
    return _empty(owner, number, Marker.DELETE)


def _empty(owner: str, number: int, action: int) -> Marker:
    # Without a stamp: the newest transform to the world's frame will do.
    marker = Marker(ns=owner, id=number, action=action)
    marker.header.frame_id = WORLD_FRAME
    return marker
