"""The robots in the 3D view, and the switches for their layers."""

import time
from collections.abc import Callable, Collection, Container, Mapping
from dataclasses import dataclass

from viser import GuiApi, GuiCheckboxHandle, SceneApi

from arm_description.urdf.robot import Robot
from arm_node.names import listing
from arm_viewer.panels.panel import in_order, say
from arm_viewer.requests import Send, ShowContacts
from arm_viewer.scene.cameras import Cameras
from arm_viewer.scene.contact_lines import ContactLines
from arm_viewer.scene.first_view import Contents, FirstView
from arm_viewer.scene.frames import Frames, assumed_transforms, node_name, unknown_joints
from arm_viewer.scene.markers import Markers
from arm_viewer.scene.poses import Poses
from arm_viewer.scene.robot_model import COLLISION, INERTIA, MASS, VISUAL, RobotModel
from arm_viewer.snapshot import Description, Snapshot, Transform, frame_name

SWITCHES = {
    VISUAL: ("Visual", "visuals of the links"),
    COLLISION: ("Collision", "collision shapes of the links"),
    MASS: ("Centre of mass", "balls of lead with the links' masses"),
    INERTIA: ("Inertia", "solid ellipsoids with the links' masses and inertias"),
}

MAX_LISTED = 8
NO_CONTACT = "Nothing touches."
UNKNOWN_CONTACTS = (
    "Contacts are not known: nobody publishes contact_markers, or the recording has none."
)
STARTUP_WAIT_S = 1.5
"""How long the page waits for a robot's joint states and transforms before it reports a problem."""


@dataclass(frozen=True, slots=True)
class _Shown:
    """A robot in the view, its description, and the frames of its links."""

    description: Description
    places: Mapping[str, str]
    model: RobotModel
    since_s: float


_Known = tuple[
    Mapping[str, Transform], Mapping[str, Mapping[str, float]], set[str], dict[str, _Shown]
]
"""Published transforms, hardware positions, the robots that have waited for both, all robots."""


class RobotPanel:
    """Draws the robots of the 3D view as described, at their poses in /tf."""

    def __init__(
        self,
        scene: SceneApi,
        frames: Frames,
        poses: Poses,
        view: FirstView,
        on_click: Callable[[str], None],
        send: Send,
        is_watched: Callable[[], bool],
    ) -> None:
        """Draw into this scene, below these frames, move things by `poses`, and fit this view.

        `on_click` takes the name of a thing of the world that was clicked, in viser's threads.
        """
        self._send = send
        self._is_watched = is_watched
        self._contacts = ContactLines(scene, frames)
        self._wants_contacts = False
        self._scene = scene
        self._poses = poses
        self._view = view
        self._fit_for: set[int] = set()
        self._frames = frames
        self._markers = Markers(scene, frames, poses, on_click)
        self._cameras = Cameras(scene, frames)
        self._robots: dict[str, _Shown] = {}
        self._completed_for: _Known | None = None
        self._completed: Mapping[str, Transform] = {}

    def build(self, gui: GuiApi) -> None:
        """Create the switches."""
        with gui.add_folder("Show"):
            self._layers = {
                layer: gui.add_checkbox(label, layer == VISUAL, hint=hint)
                for layer, (label, hint) in SWITCHES.items()
            }
            self._axes = gui.add_checkbox("Frames", False, hint="axes: x red, y green, z blue")
            self._names = gui.add_checkbox("Frame names", False)
            self._views = gui.add_checkbox(
                "Cameras", True, hint="frustums of the cameras, from CameraInfo and /tf"
            )
            self._world = gui.add_checkbox("World", True, hint="objects around the robots")
            self._touching = gui.add_checkbox(
                "Contacts", False, hint="where things touch, and lines as long as the forces there"
            )
            self._strongest = gui.add_html("", visible=False)
            fit = gui.add_button("Fit view", color="gray", hint="all robots and nearby objects")
        fit.on_click(in_order(lambda event: self._fit_for.add(event.client_id or 0)))
        self._problem = gui.add_html("", visible=False)

    @property
    def switches(self) -> Mapping[str, GuiCheckboxHandle]:
        """The switches that an RViz configuration knows, by their keys there."""
        others = {"frames": self._axes, "frame names": self._names, "world": self._world}
        return {**self._layers, **others}

    def update(self, snapshot: Snapshot) -> None:
        """Show the selected layers at the present transforms."""
        transforms = snapshot.transforms
        self._frames.update(self._with_assumed(snapshot))
        self._frames.show_axes(self._axes.value)
        self._frames.show_names(self._names.value)
        self._markers.update(snapshot.markers)
        self._markers.show(self._world.value, transparent=self._touching.value)
        self._show_contacts(snapshot)
        self._poses.send(time.monotonic())
        self._cameras.update(snapshot.cameras, self._views.value)
        for topic in self._robots.keys() - snapshot.descriptions.keys():
            self._robots.pop(topic).model.remove()
        for topic, description in snapshot.descriptions.items():
            self._renew(topic, description, snapshot)
        layers = {layer for layer, switch in self._layers.items() if switch.value}
        inside = self._axes.value or self._touching.value or bool(layers & {MASS, INERTIA})
        for shown in self._robots.values():
            grey = bool(_reason_for_grey(snapshot, shown))
            # Wait for all transforms, because a hand without some of them would appear in the foot.
            drawn = layers if _is_placed(snapshot, shown) else set[str]()
            shown.model.show(drawn, transparent=inside, grey=grey)
        frames = {*transforms, *(step.parent for step in transforms.values())}
        say(self._problem, _problem(snapshot, self._robots.values(), frames))
        self._update_view(snapshot)

    def _show_contacts(self, snapshot: Snapshot) -> None:
        """Draw the contacts, which are asked for only while they are looked at."""
        is_shown = self._touching.value
        wanted = is_shown and self._is_watched()
        if wanted != self._wants_contacts:
            self._wants_contacts = wanted
            self._send(ShowContacts(wanted))
        contacts = snapshot.contacts if is_shown else None
        self._contacts.show(contacts)
        lines = UNKNOWN_CONTACTS if contacts is None else "\n".join(contacts.strongest)
        say(self._strongest, (lines or NO_CONTACT) if is_shown else "", "inherit")

    def _update_view(self, snapshot: Snapshot) -> None:
        """Fit the view to the present contents."""
        placed = {t for t, shown in self._robots.items() if _is_placed(snapshot, shown)}
        key = (frozenset((t, id(self._robots[t])) for t in placed), frozenset(snapshot.markers))
        while self._fit_for:
            self._view.fit_again(self._fit_for.pop())
        if self._view.is_due(key, snapshot.made_s):
            robots = [b for topic in placed for b in self._robots[topic].model.bodies()]
            self._view.set_contents(Contents(robots, *self._markers.bodies()))
        self._view.update()

    def _with_assumed(self, snapshot: Snapshot) -> Mapping[str, Transform]:
        """Return the transforms, with those of joints that are not published.

        These joints are where the hardware has them, or else where the description starts them.

        It is the same object as long as nothing has changed.
        """
        waited = {topic for topic, shown in self._robots.items() if _has_waited(snapshot, shown)}
        key = (
            snapshot.transforms,
            snapshot.hardware_positions,
            waited,
            dict(self._robots),
        )
        if self._completed_for is None or not _same(self._completed_for, key):
            self._completed_for = key
            assumed: dict[str, Transform] = {}
            for topic in waited:
                shown = self._robots[topic]
                if shown.description.robot is not None:
                    assumed |= assumed_transforms(
                        shown.description.robot,
                        shown.places,
                        {**shown.description.initial, **_hardware_positions(snapshot, shown)},
                        snapshot.transforms,
                    )
            self._completed = {**assumed, **snapshot.transforms} if assumed else snapshot.transforms
        return self._completed

    def _renew(self, topic: str, description: Description, snapshot: Snapshot) -> None:
        """Recreate a robot if its description or its links' frames have changed."""
        shown = self._robots.get(topic)
        robot = description.robot
        places = (
            {} if robot is None else link_frames(robot, description.namespace, self._frames.known)
        )
        if shown is not None:
            if shown.description is description and shown.places == places:
                return
            self._robots.pop(topic).model.remove()
        if robot is not None:
            model = RobotModel(self._scene, self._frames, node_name(topic), robot, places)
            since_s = shown.since_s if shown is not None else snapshot.made_s
            self._robots[topic] = _Shown(description, places, model, since_s)


def link_frames(robot: Robot, namespace: str, frames: Container[str]) -> dict[str, str]:
    """Return the frame of each link: prefixed with the robot's namespace, or the link's own name.

    A state publisher's frame_prefix adds the prefix if robots of one kind differ only in their
    namespaces. The prefixed frame takes precedence, because the bare name may belong to another
    robot in the root namespace.
    """
    prefix = f"{namespace.strip('/')}/"
    return {
        link.name: prefixed if (prefixed := prefix + link.name) in frames else frame_name(link.name)
        for link in robot.links
    }


def _same(first: _Known, second: _Known) -> bool:
    return first[0] is second[0] and first[1] is second[1] and first[2:] == second[2:]


def _hardware_positions(snapshot: Snapshot, shown: _Shown) -> Mapping[str, float]:
    return snapshot.hardware_positions.get(shown.description.namespace, {})


def _has_waited(snapshot: Snapshot, shown: _Shown) -> bool:
    """Return whether joint states and /tf have had enough time to arrive."""
    return snapshot.made_s - shown.since_s > STARTUP_WAIT_S


def _is_placed(snapshot: Snapshot, shown: _Shown) -> bool:
    robot = shown.description.robot
    return _has_waited(snapshot, shown) or (
        robot is not None and not unknown_joints(robot, shown.places, snapshot.transforms)
    )


def _reason_for_grey(snapshot: Snapshot, shown: _Shown) -> str:
    """Return why a robot is drawn in grey, in a sentence; empty if it is not."""
    robot, namespace = shown.description.robot, shown.description.namespace
    if robot is None or not _has_waited(snapshot, shown):
        return ""
    states = f"{namespace}/joint_states"
    measured = _hardware_positions(snapshot, shown)
    mimics = {joint.name for joint in robot.joints if joint.mimic is not None}
    unknown = [
        joint
        for joint in unknown_joints(robot, shown.places, snapshot.transforms)
        if joint not in measured and not (measured and joint in mimics)
    ]
    if unknown:
        reason = f"No position for {listing(unknown)} of {shown.description.topic}"
        if states not in snapshot.joint_states:
            reason += f" (nothing on {states})"
        return f"{reason}: drawn in grey at the initial pose"
    if states in snapshot.lost and robot.movable_joints:
        return (
            f"{states} is no longer published: {shown.description.topic} is drawn in grey at its "
            "last pose"
        )
    return ""


def _problem(snapshot: Snapshot, robots: Collection[_Shown], frames: Container[str]) -> str:
    lines = [description.problem for description in snapshot.descriptions.values()]
    for shown in robots:
        reason = _reason_for_grey(snapshot, shown)
        is_drawn = bool(reason or _hardware_positions(snapshot, shown))
        missing = [] if is_drawn else [f for f in shown.places.values() if f not in frames]
        if missing and _has_waited(snapshot, shown):
            reason = f"No transform on /tf for {listing(missing)} of {shown.description.topic}"
        lines.append(reason)
    lines += [
        f"No transform on /tf for {view.frame}, the frame of {topic}"
        for topic, view in snapshot.cameras.items()
        if view.frame not in frames
    ]
    for shown in robots:
        lines += _missing(shown.description.topic, list(shown.model.problems))
    return "\n".join(filter(None, lines))


def _missing(topic: str, problems: list[str]) -> list[str]:
    """Return the lines about a robot that is drawn incompletely."""
    if not problems:
        return []
    more = len(problems) - MAX_LISTED
    rest = [f"and {more} more, which the page's log lists"] if more > 0 else []
    return [f"Not all of {topic} can be drawn:", *problems[:MAX_LISTED], *rest]
