"""The planning scene's objects: what is there, and fields to add and remove some."""

from collections.abc import Iterable
from dataclasses import dataclass

from viser import GuiApi, SceneApi

from arm_node.rigid_transform import RigidTransform
from arm_planning.robot.model import PlanningModel
from arm_planning.scene.frames import LinkPoses
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_viewer.panels.panel import in_order, note, say
from arm_viewer.planning import PlanningView
from arm_viewer.requests import AddObject, RemoveObject, Send
from arm_viewer.scene.planning_objects import PlanningObjects
from arm_viewer.world.shape_fields import KINDS, SIZE_HINT, ObjectKind, read_pose, read_shape

NOTHING = "(none)"
EMPTY = "The planning scene has no objects."
POSITION_M, NO_TURN = "0.2 0 0.1", "0 0 0"


class SceneObjectPanel:
    """The elements of one move_group; use it in viser's event loop."""

    def __init__(
        self, gui: GuiApi, scene: SceneApi, namespace: str, model: PlanningModel, send: Send
    ) -> None:
        """Create the elements in the open container."""
        self._namespace = namespace
        self._frame = model.frame
        self._send = send
        self._objects = PlanningObjects(scene, f"{namespace}/objects")
        self._wrong = ""
        self._is_shown = gui.add_checkbox(
            "Show objects", True, hint="green: in the world; purple: on the robot"
        )
        self._list = gui.add_html(note(EMPTY))
        self._chosen = gui.add_dropdown("Object", options(()))
        remove = gui.add_button("Remove", color="gray")
        remove.on_click(in_order(lambda _: self._remove()))
        self._build_fields(gui)
        self._problem = gui.add_html("", visible=False)

    def update(self, view: PlanningView, origin: RigidTransform, links: LinkPoses) -> None:
        """Show a move_group's scene, at the pose of the robot's root link in the 3D view."""
        self._objects.update(view.scene if self._is_shown.value else None, origin, links)
        names = options(view.scene.objects if view.scene is not None else ())
        if self._chosen.options != names:
            self._chosen.options = names
        say(self._list, described(view.scene), "inherit")
        say(self._problem, self._wrong or view.scene_problem)

    def remove(self) -> None:
        """Remove the objects from the 3D view; the elements go with their container."""
        self._objects.remove()

    def _build_fields(self, gui: GuiApi) -> None:
        self._kind = gui.add_dropdown("Shape", tuple(KINDS), initial_value=ObjectKind.BOX.word)
        self._name = gui.add_text("Name", "box1", hint="an object of this name is replaced")
        self._size = gui.add_text("Size", ObjectKind.BOX.example, hint=SIZE_HINT)
        self._position = gui.add_text(
            "Position", POSITION_M, hint=f"x y z of its centre in {self._frame}, in m"
        )
        self._rpy = gui.add_text("Orientation", NO_TURN, hint="roll pitch yaw in rad")
        add = gui.add_button("Add")
        self._kind.on_update(in_order(lambda _: self._choose_kind()))
        add.on_click(in_order(lambda _: self._add()))

    def _choose_kind(self) -> None:
        kind = KINDS[self._kind.value]
        self._size.value, self._name.value = kind.example, f"{kind.word}1"

    def _add(self) -> None:
        fields = ObjectFields(
            self._name.value,
            KINDS[self._kind.value],
            self._size.value,
            self._position.value,
            self._rpy.value,
        )
        try:
            added = new_object(fields)
        except ValueError as error:
            self._wrong = str(error)
            return
        self._wrong = ""
        self._send(AddObject(self._namespace, added))

    def _remove(self) -> None:
        self._wrong = ""
        if self._chosen.value != NOTHING:
            self._send(RemoveObject(self._namespace, self._chosen.value))


@dataclass(frozen=True, slots=True)
class ObjectFields:
    """What the user has entered, as it is.

    Attributes:
        name: name of the object.
        kind: its shape.
        size: the lengths of its kind, in m.
        position: of its centre in the planning frame, x y z in m.
        rpy: roll, pitch and yaw, in rad.
    """

    name: str
    kind: ObjectKind
    size: str
    position: str
    rpy: str


def new_object(fields: ObjectFields) -> CollisionObject:
    """Return the object.

    Raises:
        ValueError: it has no name, or a number cannot be used; the message is a sentence.
    """
    name = fields.name.strip()
    if not name:
        raise ValueError("The object needs a name.")
    pose = read_pose(fields.position, fields.rpy)
    return CollisionObject(name, pose, (PlacedShape(read_shape(fields.kind, fields.size)),))


def options(names: Iterable[str]) -> tuple[str, ...]:
    """Return the options of a list of objects, which viser does not allow to be empty."""
    return tuple(names) or (NOTHING,)


def described(scene: PlanningScene | None) -> str:
    """Return a line for each object: its name, and what it is attached to."""
    if scene is None:
        return "The planning scene is not known yet."
    lines = [*scene.objects]
    lines += [f"{name}, attached to {body.link}" for name, body in scene.attached.items()]
    return "\n".join(lines) or EMPTY
