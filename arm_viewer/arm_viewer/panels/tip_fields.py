"""The goal of a group's tip by numbers: where it is, and how it is turned."""

from collections.abc import Callable

import numpy as np
from viser import GuiApi

from arm_description.transforms import rotation_from_quaternion, rpy_from_rotation
from arm_node.rigid_transform import RigidTransform
from arm_planning.robot.model import JointGroup
from arm_viewer.panels.panel import PROBLEM_COLOUR, in_order, note, show
from arm_viewer.world.shape_fields import read_pose

DIGITS = 4


class TipFields:
    """Elements in the open container; use it in viser's event loop."""

    def __init__(self, gui: GuiApi, take: Callable[[RigidTransform], None]) -> None:
        """Create the elements.

        Args:
            gui: gets the elements.
            take: gets the pose in the frame of the robot's root, in m.
        """
        self._take = take
        self._of = ""
        self._folder = gui.add_folder("Tip by numbers", expand_by_default=False)
        with self._folder:
            self._position = gui.add_text("Tip at", "", hint="x y z from the robot's root, in m")
            self._rpy = gui.add_text("Tip turned", "", hint="roll pitch yaw in rad")
            go = gui.add_button("Set goal", color="gray")
            self._problem = gui.add_html("", visible=False)
        go.on_click(in_order(lambda _: self._read()))

    def show(self, group: JointGroup | None, pose_of: Callable[[str], RigidTransform]) -> None:
        """Begin with a group's pose; hide the fields for a group without a tip.

        Args:
            group: that is chosen.
            pose_of: returns the present pose of a link.
        """
        show(self._folder, group is not None and bool(group.tip))
        if group is not None and group.tip and group.name != self._of:
            self._of = group.name
            tip = pose_of(group.tip)
            self._position.value = _text(tip.position)
            rotation = rotation_from_quaternion(np.array(tip.rotation))
            self._rpy.value = _text(rpy_from_rotation(rotation))

    def _read(self) -> None:
        problem = ""
        try:
            self._take(read_pose(self._position.value, self._rpy.value))
        except ValueError as error:
            problem = str(error)
        self._problem.content = note(problem, PROBLEM_COLOUR)
        self._problem.visible = bool(problem)


def _text(numbers: tuple[float, ...]) -> str:
    # Adding 0 turns -0.0 into 0.0.
    return " ".join(f"{round(number, DIGITS) + 0.0:g}" for number in numbers)
