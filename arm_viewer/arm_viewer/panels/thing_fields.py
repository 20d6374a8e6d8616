"""The fields in which a user describes a thing to add to the world."""

from viser import GuiApi

from arm_node.rigid_transform import RigidTransform
from arm_viewer.panels.panel import in_order
from arm_viewer.world.new_thing import ThingFields, new_thing
from arm_viewer.world.shape_fields import KINDS, SIZE_HINT, ObjectKind, read_pose
from arm_viewer.world_requests import AddThing

ORANGE = (230, 119, 0)
POSITION_M, NO_TURN = "0.25 0 0.2", "0 0 0"


class ThingFieldsPanel:
    """Elements in the open container; use it in viser's event loop."""

    def __init__(self, gui: GuiApi) -> None:
        """Create the elements."""
        self._kind = gui.add_dropdown("Shape", tuple(KINDS), initial_value=ObjectKind.BOX.word)
        self._name = gui.add_text("Name", ObjectKind.BOX.word, hint="a taken name gets a number")
        self._size = gui.add_text("Size", ObjectKind.BOX.example, hint=SIZE_HINT)
        self._position = gui.add_text("Position", POSITION_M, hint="x y z in the world, in m")
        self._rpy = gui.add_text("Orientation", NO_TURN, hint="roll pitch yaw in rad")
        self._rgb = gui.add_rgb("Colour", ORANGE)
        self._mass = gui.add_number("Mass", 0.1, min=0.0, step=0.001, hint="kg")
        self._friction = gui.add_number("Friction", 1.0, min=0.0, step=0.01, hint="coefficient")
        self._is_fixed = gui.add_checkbox("Fixed", False, hint="it stays where it is")
        self._kind.on_update(in_order(lambda _: self._choose_kind()))

    def request(self) -> AddThing:
        """Return the request to add what the fields describe.

        Raises:
            ValueError: a field cannot be used; the message is a sentence.
        """
        fields = ThingFields(
            self._name.value.strip(),
            KINDS[self._kind.value],
            self._size.value,
            self._position.value,
            self._rpy.value,
            self._rgb.value,
            self._mass.value,
            self._friction.value,
            self._is_fixed.value,
        )
        text, pose = new_thing(fields)
        return AddThing(fields.name, text, pose)

    def pose(self) -> RigidTransform:
        """Return the pose in the fields.

        Raises:
            ValueError: it cannot be used; the message is a sentence.
        """
        return read_pose(self._position.value, self._rpy.value)

    def _choose_kind(self) -> None:
        kind = KINDS[self._kind.value]
        self._size.value, self._name.value = kind.example, kind.word
