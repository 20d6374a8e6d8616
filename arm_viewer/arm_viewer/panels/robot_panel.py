"""What of the robots is shown: the switches, and the robots themselves in the 3D view."""

from collections.abc import Collection, Container, Mapping
from dataclasses import dataclass

from viser import GuiApi, SceneApi

from arm_description.names import listing
from arm_description.robot import Robot
from arm_viewer.frame_name import frame_name
from arm_viewer.panels.note import PROBLEM_COLOUR, note
from arm_viewer.scene.cameras import Cameras
from arm_viewer.scene.frames import Frames
from arm_viewer.scene.markers import Markers
from arm_viewer.scene.node_name import node_name
from arm_viewer.scene.robot_model import COLLISION, INERTIA, MASS, VISUAL, RobotModel
from arm_viewer.snapshot import Description, Snapshot

SWITCHES = {
    VISUAL: ("Visual", "what the links look like"),
    COLLISION: ("Collision", "what the links are touched by"),
    MASS: ("Centre of mass", "balls of lead of the links' masses"),
    INERTIA: ("Inertia", "solid ellipsoids of the links' masses and inertias"),
}

LISTED_AT_MOST = 8


@dataclass(frozen=True, slots=True)
class _Shown:
    """A robot in the view, what it was made of, and where its links were taken to be."""

    description: Description
    places: Mapping[str, str]
    model: RobotModel


class RobotPanel:
    """Keeps the robots of the 3D view as they are described, where /tf says they are."""

    def __init__(self, scene: SceneApi, frames: Frames) -> None:
        """Draw into this scene, below these frames."""
        self._scene = scene
        self._frames = frames
        self._markers = Markers(scene, frames)
        self._cameras = Cameras(scene, frames)
        self._robots: dict[str, _Shown] = {}

    def build(self, gui: GuiApi) -> None:
        """Make the switches."""
        with gui.add_folder("Show"):
            self._layers = {
                layer: gui.add_checkbox(label, layer == VISUAL, hint=hint)
                for layer, (label, hint) in SWITCHES.items()
            }
            self._axes = gui.add_checkbox("Frames", False, hint="axes: x red, y green, z blue")
            self._names = gui.add_checkbox("Frame names", False)
            self._views = gui.add_checkbox(
                "Cameras", True, hint="what they see, from where; by CameraInfo and /tf"
            )
            self._world = gui.add_checkbox("World", True, hint="what stands around the robots")
        self._shown_problem = ""
        self._problem = gui.add_html("", visible=False)

    def update(self, snapshot: Snapshot) -> None:
        """Show what the switches say, where the transforms say."""
        self._frames.update(snapshot.transforms)
        self._frames.show_axes(self._axes.value)
        self._frames.show_names(self._names.value)
        self._markers.update(snapshot.markers)
        self._markers.show(self._world.value)
        self._cameras.update(snapshot.cameras, self._views.value)
        for topic, description in snapshot.descriptions.items():
            self._renew(topic, description)
        layers = {layer for layer, switch in self._layers.items() if switch.value}
        inside = self._axes.value or bool(layers & {MASS, INERTIA})
        for shown in self._robots.values():
            shown.model.show(layers, seen_through=inside)
        self._say(_problem(snapshot, self._robots.values(), self._frames.known))

    def _renew(self, topic: str, description: Description) -> None:
        """Make a robot anew where its description is another one, or its links' frames are."""
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
            self._robots[topic] = _Shown(description, places, model)

    def _say(self, problem: str) -> None:
        if self._shown_problem != problem:
            self._shown_problem = problem
            self._problem.content = note(problem, PROBLEM_COLOUR)
            self._problem.visible = bool(problem)


def link_frames(robot: Robot, namespace: str, frames: Container[str]) -> dict[str, str]:
    """Return the frame of each link: that below the robot's namespace, or its own name.

    The first is what a state publisher's frame_prefix is used for, where robots of one kind are
    told apart by namespaces only. It goes first: the bare name may be another robot's, of the root
    namespace.
    """
    prefix = f"{namespace.strip('/')}/"
    return {
        link.name: prefixed if (prefixed := prefix + link.name) in frames else frame_name(link.name)
        for link in robot.links
    }


def _problem(snapshot: Snapshot, robots: Collection[_Shown], frames: Container[str]) -> str:
    lines = [description.problem for description in snapshot.descriptions.values()]
    lines += [
        f"No transform on /tf for {listing(missing)} of {shown.description.topic}"
        for shown in robots
        if (missing := [frame for frame in shown.places.values() if frame not in frames])
    ]
    lines += [
        f"No transform on /tf for {view.frame}, the frame of {topic}"
        for topic, view in snapshot.cameras.items()
        if view.frame not in frames
    ]
    for shown in robots:
        lines += _missing(shown.description.topic, list(shown.model.problems))
    return "\n".join(filter(None, lines))


def _missing(topic: str, problems: list[str]) -> list[str]:
    """Return what to say of a robot that is not whole."""
    if not problems:
        return []
    more = len(problems) - LISTED_AT_MOST
    rest = [f"and {more} more, which the page's log lists"] if more > 0 else []
    return [f"Not all of {topic} can be drawn:", *problems[:LISTED_AT_MOST], *rest]
