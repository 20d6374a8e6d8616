"""Sliders that move the joints, and follow them."""

import random
import time
from collections.abc import Callable, Mapping
from typing import Any

from viser import GuiApi, GuiEvent

from arm_viewer.joint_drive import joint_drives
from arm_viewer.joint_follower import JointFollower
from arm_viewer.joint_range import JointRange, joint_ranges
from arm_viewer.panels.follower_table import FollowerTable
from arm_viewer.panels.note import note
from arm_viewer.requests import MoveJoints, Send
from arm_viewer.snapshot import Description, JointReading, Snapshot

NO_DRIVE = "No active controller takes positions: the sliders only show them."


class JointPanel:
    """A group of sliders for each robot."""

    def __init__(self, send: Send) -> None:
        """Send movements there."""
        self._send = send
        self._groups: dict[str, _RobotSliders] = {}

    def build(self, gui: GuiApi) -> None:
        """Make the place for the sliders; they come with the robots."""
        self._gui = gui
        self._place = gui.add_folder(None)

    def update(self, snapshot: Snapshot) -> None:
        """Follow the joints, and the robots that come."""
        for topic, description in snapshot.descriptions.items():
            group = self._groups.get(topic)
            if group is None or group.description is not description:
                if group is not None:
                    group.remove()
                with self._place:
                    group = self._groups[topic] = _RobotSliders(self._gui, description, self._send)
            group.update(snapshot)


class _RobotSliders:
    """The sliders of one robot, and the buttons that move them all."""

    def __init__(self, gui: GuiApi, description: Description, send: Send) -> None:
        self.description = description
        self._send = send
        joints = () if description.robot is None else description.robot.joints
        ranges = joint_ranges(joints)
        title = f"Joints of {description.namespace}" if description.namespace else "Joints"
        self._folder = gui.add_folder(title, visible=bool(ranges))
        with self._folder:
            self._sliders = [_JointSlider(gui, joint, self._move) for joint in ranges]
            self._followers = FollowerTable(gui, joints)
            self._buttons = gui.add_button_group("All", ("Center", "Randomize"), visible=False)
            self._hint = gui.add_html(note(NO_DRIVE), visible=False)
        self._buttons.on_click(self._move_all)

    def update(self, snapshot: Snapshot) -> None:
        namespace = self.description.namespace
        displays = namespace in snapshot.displayed
        drives = joint_drives(snapshot.controllers, namespace)
        driven = {joint for drive in drives for joint in drive.joints}
        states = snapshot.joint_states.get(f"{namespace}/joint_states")
        readings: Mapping[str, JointReading] = {} if states is None else states.joints
        for slider in self._sliders:
            slider.update(readings, displays or slider.range.name in driven)
        self._followers.update(readings)
        self._buttons.visible = displays
        self._hint.visible = not (displays or driven)

    def remove(self) -> None:
        self._folder.remove()

    def _move(self) -> None:
        # With those that are still on their way, lest they stop there.
        held = {slider.range.name: slider.value for slider in self._sliders if slider.is_held()}
        self._send(MoveJoints(self.description.namespace, held))

    def _move_all(self, event: GuiEvent[Any]) -> None:
        ranges = [slider.range for slider in self._sliders]
        if event.target.value == "Center":
            positions = {joint.name: joint.centre for joint in ranges}
        else:
            positions = {joint.name: random.uniform(joint.lower, joint.upper) for joint in ranges}
        self._send(MoveJoints(self.description.namespace, positions))


class _JointSlider:
    """One joint's slider."""

    def __init__(self, gui: GuiApi, joint: JointRange, move: Callable[[], None]) -> None:
        self.range = joint
        self._move = move
        self._follower = JointFollower(joint.step)
        self._handle = gui.add_slider(
            joint.name,
            min=joint.lower,
            max=joint.upper,
            step=joint.step,
            initial_value=joint.centre,
            marks=tuple((end, f"{end:.2f}") for end in (joint.lower, joint.upper)),
        )
        self._handle.on_update(self._moved)

    @property
    def value(self) -> float:
        """What the slider shows, rad or m."""
        return self._handle.value

    def is_held(self) -> bool:
        """Whether it stays where the user put it."""
        return self._follower.is_held(time.monotonic())

    def update(self, readings: Mapping[str, JointReading], driven: bool) -> None:
        """Show where the joint is, and whether it can be moved."""
        if self._handle.disabled == driven:
            self._handle.disabled = not driven
        reading = readings.get(self.range.name)
        if reading is None:
            return
        shown = self._follower.shown(reading.position, time.monotonic())
        if shown is not None:
            self._handle.value = self.range.nearest(shown)

    def _moved(self, event: GuiEvent[Any]) -> None:
        # Without a client it was `update`, which only follows: it must not move the joint.
        if event.client_id is not None:
            self._follower.hold(time.monotonic())
            self._move()
