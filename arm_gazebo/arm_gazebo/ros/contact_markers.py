"""Where things touch and how hard, as markers that RViz and the page draw."""

from collections.abc import Sequence

import mujoco
import numpy as np
from geometry_msgs.msg import Point, Vector3
from rclpy.node import Node
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from arm_gazebo.physics.physics import Physics
from arm_gazebo.ros.world_markers import watched_publisher
from arm_gazebo.world.contacts import Contact, Vector, contacts_of
from arm_gazebo.world.editor import WorldEditor
from arm_gazebo.world.entity import WORLD_FRAME

TOPIC = "contact_markers"
MAX_CONTACTS = 200
"""The strongest are published; more could not be told apart."""
MAX_LISTED = 8
POINTS, FORCES = "points", "forces"
POINT_M, LINE_M = 0.012, 0.004
M_PER_N, LONGEST_M = 0.02, 0.4
"""Length of a force's line for each newton, and the longest line."""
POINT_RGBA, FORCE_RGBA = (1.0, 0.75, 0.0, 1.0), (0.9, 0.1, 0.1, 1.0)


class ContactMarkerPublisher:
    """Publishes the contacts ten times a second when they have changed, while somebody subscribes.

    The loop thread brings contacts to the present state and copies them; the rest happens on the
    thread of the node's executor, which is the editor's thread. Nothing of it changes the run.
    """

    def __init__(self, node: Node, editor: WorldEditor, physics: Physics) -> None:
        self._node = node
        self._editor = editor
        self._physics = physics
        self._publisher = watched_publisher(node, TOPIC, self._check, self._repeat)
        self._model: mujoco.MjModel | None = None
        self._data: mujoco.MjData
        self._sent: MarkerArray | None = None

    def _repeat(self) -> None:
        self._sent = None

    def _check(self) -> None:
        # Fast DDS may count a subscription that ended right after it began for ever.
        if not self._node.count_subscribers(self._publisher.topic_name):
            return
        model = self._editor.model
        if model is not self._model:
            self._model, self._data = model, mujoco.MjData(model)
        self._editor.on_loop(self._copy)
        message = contact_markers(contacts_of(None, model, self._data, self._editor.entities))
        if message != self._sent:
            self._sent = message
            self._publisher.publish(message)

    def _copy(self) -> None:
        """Copy the present state with its contacts. Loop thread."""
        mujoco.mj_copyData(self._data, self._physics.model, self._physics.observe())


def contact_markers(contacts: Sequence[Contact]) -> MarkerArray:
    """Return a marker with the points and one with the forces, each as a line from its point.

    The line shows the force on one of the two, which is never the world. The text of that marker
    lists the strongest pairs; RViz does not show it.
    """
    acting = [_acting(contact) for contact in contacts]
    strengths = [float(np.linalg.norm(force)) for _, force in acting]
    order = sorted(range(len(contacts)), key=strengths.__getitem__, reverse=True)[:MAX_CONTACTS]
    points = _marker(POINTS, Marker.SPHERE_LIST, POINT_M, POINT_RGBA)
    forces = _marker(FORCES, Marker.LINE_LIST, LINE_M, FORCE_RGBA)
    points.scale = Vector3(x=POINT_M, y=POINT_M, z=POINT_M)
    places = [contacts[index].position for index in order]
    ends = [
        place + min(M_PER_N, LONGEST_M / max(strengths[index], 1e-9)) * acting[index][1]
        for index, place in zip(order, places, strict=True)
    ]
    points.points = [_point(place) for place in places]
    forces.points = [_point(p) for pair in zip(places, ends, strict=True) for p in pair]
    forces.text = "\n".join(_strongest(acting))
    if not order:
        # RViz complains about lists without points.
        points.action = forces.action = Marker.DELETE
    return MarkerArray(markers=[points, forces])


def _acting(contact: Contact) -> tuple[tuple[str, str], Vector]:
    """Return a body, what it touches, and the force on it."""
    if contact.other == WORLD_FRAME:
        return (contact.body, contact.other), contact.force
    return (contact.other, contact.body), -contact.force


def _strongest(acting: Sequence[tuple[tuple[str, str], Vector]]) -> list[str]:
    """Return a line about each of the pairs with the strongest sums of forces."""
    sums: dict[tuple[str, str], Vector] = {}
    for (body, other), force in acting:
        if (other, body) in sums:
            body, other, force = other, body, -force
        sums[body, other] = sums.get((body, other), np.zeros(3)) + force
    strengths = {pair: float(np.linalg.norm(total)) for pair, total in sums.items()}
    pairs = sorted(strengths, key=strengths.__getitem__, reverse=True)[:MAX_LISTED]
    return [f"{body} on {other}: {strengths[body, other]:.3g} N" for body, other in pairs]


def _marker(name: str, kind: int, width_m: float, rgba: tuple[float, ...]) -> Marker:
    # A zero stamp means the latest transform to the world's frame.
    marker = Marker(ns=name, type=kind, action=Marker.ADD)
    marker.header.frame_id = WORLD_FRAME
    marker.pose.orientation.w = 1.0
    marker.scale.x = width_m
    marker.color = ColorRGBA(**dict(zip("rgba", rgba, strict=True)))
    return marker


def _point(place: Vector) -> Point:
    x, y, z = place.tolist()
    return Point(x=x, y=y, z=z)
