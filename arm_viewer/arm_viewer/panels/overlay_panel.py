"""What is drawn over the robots: a link's way and reach, centres of mass, the loads of joints."""

import time
from html import escape

from viser import GuiApi, SceneApi

from arm_description.urdf.joint_type import JointType
from arm_description.urdf.robot import Joint
from arm_viewer.panels.panel import distinct, fill, in_order, note, say
from arm_viewer.panels.robot_panel import link_frames
from arm_viewer.scene.frames import Frames, node_name
from arm_viewer.scene.reach import ReachCloud
from arm_viewer.scene.robot_quantities import (
    RobotQuantities,
    centre_of_mass,
    joint_loads,
    load_colour,
)
from arm_viewer.scene.trail import PointTrail
from arm_viewer.snapshot import Snapshot

NO_LINK = "(none)"
_NO_LINKS: tuple[str, ...] = (NO_LINK,)
PERIOD_S = 0.1
NO_LOADS = "No joint has both an effort on /joint_states and a limit of it."
NO_MASS = "No robot has masses."


class OverlayPanel:
    """Switches of the overlays, and their figures; use it in viser's event loop."""

    def __init__(self, scene: SceneApi, frames: Frames) -> None:
        """Draw into this scene, in these frames."""
        self._scene = scene
        self._frames = frames
        self._trail = PointTrail(scene)
        self._trailed = NO_LINK
        self._reach = ReachCloud(scene)
        self._reaching: tuple[str, RobotQuantities | None] = NO_LINK, None
        self._replay = ""
        self._robots: dict[str, RobotQuantities] = {}
        self._is_cleared = False
        self._drawn_s = 0.0

    def build(self, gui: GuiApi) -> None:
        """Create the elements."""
        with gui.add_folder("Overlays", expand_by_default=False):
            self._of = gui.add_dropdown("Trail of", _NO_LINKS, hint="the way of a link")
            clear = gui.add_button("Clear trail", color="gray")
            self._reach_of = gui.add_dropdown(
                "Reach of",
                _NO_LINKS,
                hint="places within the joints' limits; what touches is left in",
            )
            self._centre = gui.add_checkbox("Robot's centre of mass", False)
            self._masses = gui.add_html("", visible=False)
            self._efforts = gui.add_checkbox(
                "Efforts", False, hint="discs at the joints, from green to red at the limit"
            )
            self._loads = gui.add_html("", visible=False)
        clear.on_click(in_order(lambda _: self._clear()))

    def update(self, snapshot: Snapshot) -> None:
        """Draw what is switched on."""
        self._renew(snapshot)
        poses = self._frames.known
        if self._is_cleared or (self._of.value, snapshot.replay) != (self._trailed, self._replay):
            self._is_cleared = False
            self._trailed, self._replay = self._of.value, snapshot.replay
            self._trail.clear()
        if self._trailed in poses:
            self._trail.add(poses[self._trailed].position)
        now_s = time.monotonic()
        if now_s - self._drawn_s < PERIOD_S:
            return
        self._drawn_s = now_s
        self._trail.draw()
        self._show_reach()
        self._show_masses()
        self._show_loads(snapshot)

    def _renew(self, snapshot: Snapshot) -> None:
        """Keep the robots and their links' frames."""
        known = self._frames.known
        for topic in self._robots.keys() - snapshot.descriptions.keys():
            self._robots.pop(topic).remove()
        links: list[str] = []
        for topic, description in snapshot.descriptions.items():
            robot, shown = description.robot, self._robots.get(topic)
            if robot is None:
                continue
            places = link_frames(robot, description.namespace, known)
            links += [places[link.name] for link in reversed(robot.links)]
            if shown is None or shown.robot is not robot or shown.places != places:
                if shown is not None:
                    shown.remove()
                self._robots[topic] = RobotQuantities(
                    self._scene, self._frames, node_name(topic), robot, places
                )
        # The tips come last in a description.
        options = distinct((NO_LINK, *links))
        for choice in (self._of, self._reach_of):
            if choice.options != options:
                choice.options = options

    def _show_reach(self) -> None:
        """Draw the reach of the chosen link once, and again for another robot."""
        frame = self._reach_of.value
        found = next((r for r in self._robots.values() if frame in r.places.values()), None)
        if (frame, found) == self._reaching:
            return
        self._reaching = frame, found
        if found is None:
            self._reach.hide()
            return
        link = next(link for link, place in found.places.items() if place == frame)
        root = found.places[found.robot.root]
        self._reach.show(found.robot, link, self._frames.path(root))

    def _show_masses(self) -> None:
        lines: list[str] = []
        for topic, shown in self._robots.items():
            found = centre_of_mass(shown.robot, shown.places, self._frames.known)
            is_shown = self._centre.value and found is not None
            shown.show_centre(found[1] if found is not None and is_shown else None)
            if found is not None:
                at = " ".join(f"{value:.3f}" for value in found[1])
                lines.append(f"{shown.robot.name or topic}: {found[0]:.3f} kg at {at} m")
        say(self._masses, ("\n".join(lines) or NO_MASS) if self._centre.value else "", "inherit")

    def _show_loads(self, snapshot: Snapshot) -> None:
        rows: list[str] = []
        for topic, shown in self._robots.items():
            namespace = snapshot.descriptions[topic].namespace
            readings = snapshot.readings(namespace) if self._efforts.value else {}
            loads = joint_loads(shown.robot, readings)
            shown.show_loads(loads)
            rows += [
                load_row(joint, loads[joint.name], readings[joint.name].effort)
                for joint in shown.robot.movable_joints
                if joint.name in loads
            ]
        fill(self._loads, ("".join(rows) or note(NO_LOADS)) if self._efforts.value else "")

    def _clear(self) -> None:
        self._is_cleared = True


def load_row(joint: Joint, load: float, effort: float) -> str:
    """Return a line about a joint's effort, as HTML, with its colour and in figures."""
    red, green, blue = load_colour(load)
    unit = "N" if joint.type is JointType.PRISMATIC else "N m"
    return (
        '<div style="font-size:0.8rem;padding:0 0.75em;display:flex;gap:0.5em">'
        f'<span style="color:rgb({red},{green},{blue})">&#9679;</span>'
        f'<span style="flex:1">{escape(joint.name)}</span>'
        f"<span>{effort:.3f} {unit} ({abs(load):.0%})</span></div>"
    )
