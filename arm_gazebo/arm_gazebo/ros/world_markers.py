"""The shapes of a world as markers: made of any model, and published while they move."""

import math
from collections.abc import Callable
from contextlib import suppress

import numpy as np
from geometry_msgs.msg import Point, Vector3
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.event_handler import PublisherEventCallbacks, QoSPublisherMatchedInfo
from rclpy.node import Node
from rclpy.publisher import Publisher
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from arm_gazebo.errors import RequestError
from arm_gazebo.world.editor import WorldEditor
from arm_gazebo.world.entity import WORLD_FRAME
from arm_gazebo.world.shapes import Solid, WorldShape, WorldShapes
from arm_node.qos import LATCHED
from arm_node.workarounds.message_template import MessageTemplate

TOPIC = "world_markers"
MARKER_PERIOD_S = 0.1
MOVED = 1e-4
"""Smallest change of a coordinate, in m or of a quaternion, that counts as motion."""
TYPES = {
    Solid.BOX: Marker.CUBE,
    Solid.BALL: Marker.SPHERE,
    Solid.CYLINDER: Marker.CYLINDER,
    Solid.TRIANGLES: Marker.TRIANGLE_LIST,
}
MAX_REMOVED = 1000
"""Limit on the deleted shapes that every message repeats, because a message may be lost."""


class WorldMarkerPublisher:
    """Publishes all shapes when something has moved, at most ten times a second.

    Every message contains all shapes, so that a late subscriber needs only the last one. It is
    serialised once for each model; then only the poses in its bytes change. It runs on the thread
    of the node's executor, which is the editor's thread, and only while there are subscribers.
    """

    def __init__(self, node: Node, editor: WorldEditor) -> None:
        self._editor = editor
        self._publisher = watched_publisher(node, TOPIC, self._check, self._repeat)
        self._has_new_subscriber = False
        self._model: object = None
        self._shown: dict[tuple[str, int], None] = {}
        self._removed: dict[tuple[str, int], None] = {}

    def _repeat(self) -> None:
        self._has_new_subscriber = True

    def _check(self) -> None:
        if self._model is not self._editor.model:
            self._take_model()
        poses = self._shapes.poses(*self._editor.motions().geom_poses)
        if self._has_new_subscriber or not np.abs(poses - self._poses).max(initial=0.0) < MOVED:
            self._poses = poses
            self._template.float64[self._places] = poses.ravel()
            self._template.publish(self._publisher)
            self._has_new_subscriber = False

    def _take_model(self) -> None:
        self._model = self._editor.model
        self._shapes = WorldShapes(self._editor.model, self._editor.entities)
        shown = dict.fromkeys(shape.key for shape in self._shapes.shapes)
        before = {**self._removed, **self._shown}
        self._removed = dict.fromkeys([key for key in before if key not in shown][-MAX_REMOVED:])
        self._shown = shown
        markers = [marker_of(shape) for shape in self._shapes.shapes]
        deletions = [_deletion(owner, number) for owner, number in self._removed]
        self._template = MessageTemplate(MarkerArray(markers=[*markers, *deletions]))
        places = self._template.indices("markers[*].pose")
        self._places = places[: 7 * len(markers)]
        # NaN makes every shape count as moved in the next comparison.
        self._poses = np.full((len(markers), 7), math.nan)


def watched_publisher(
    node: Node, topic: str, check: Callable[[], None], repeat: Callable[[], None]
) -> Publisher:
    """Return a latched publisher of markers that costs nothing while nobody subscribes.

    Args:
        node: gets the publisher; its executor runs both functions.
        topic: name of the topic.
        check: called ten times a second of wall time while there are subscribers. A RequestError of
            it is dropped: a loop that is stuck is reported on /diagnostics.
        repeat: called for each new subscriber, before the next check.
    """

    def check_if_answered() -> None:
        with suppress(RequestError):
            check()

    steady = Clock(clock_type=ClockType.STEADY_TIME)
    timer = node.create_timer(MARKER_PERIOD_S, check_if_answered, clock=steady)
    timer.cancel()

    def match(matched: QoSPublisherMatchedInfo) -> None:
        if not matched.current_count:
            timer.cancel()
        elif matched.current_count_change > 0:
            repeat()
            timer.reset()

    events = PublisherEventCallbacks(matched=match)
    return node.create_publisher(MarkerArray, topic, LATCHED, event_callbacks=events)


def marker_of(shape: WorldShape) -> Marker:
    """Return the marker of a shape, without its pose."""
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
    # A zero stamp means the latest transform to the world's frame.
    marker = Marker(ns=owner, id=number, action=action)
    marker.header.frame_id = WORLD_FRAME
    return marker
