"""The tab of the world: its things, a handle to move one, and what can be added or loaded."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from html import escape

from viser import GuiApi, SceneApi

from arm_node.rigid_transform import RigidTransform, Vector
from arm_viewer.channel import Browser, Channel, Message
from arm_viewer.panels.file_drop import FileDrop
from arm_viewer.panels.panel import PROBLEM_COLOUR, distinct, fill, in_order, note, say, show
from arm_viewer.requests import (
    AddFile,
    AddThing,
    LookAtThing,
    OpenWorld,
    PlaceThing,
    PushThing,
    RemoveThing,
    Send,
    SetGravity,
    SetProperties,
    WorldRequest,
)
from arm_viewer.scene.drag_handle import DragHandle
from arm_viewer.snapshot import Snapshot
from arm_viewer.world.dropped_file import DroppedFile
from arm_viewer.world.new_thing import ThingFields, new_thing
from arm_viewer.world.shape_fields import (
    KINDS,
    SIZE_HINT,
    ObjectKind,
    read_number,
    read_numbers,
    read_pose,
)
from arm_viewer.world.world_view import Thing, ThingProperties, WorldView, gravity_words

CHOOSE = "choose_thing"
"""A browser's message: the name of the thing that is chosen; empty for none."""
NO_WORLDS: tuple[str, ...] = ("(none)",)
NO_THINGS = "The world has nothing but its robots."
NO_SIMULATION = "No simulation serves its world: nothing can be added or moved."
REPLAYED = "This is a recording: go back to live to change the world."
DROP = "Drop a URDF, SDF or STL file anywhere on the page; it goes to the position above."
PUSH_M_S = "0.5 0 0"
UNITS_M = {"metres": 1.0, "millimetres": 0.001, "inches": 0.0254}
HANDLE = "/world_handle"
ORANGE = (230, 119, 0)
POSITION_M, NO_TURN = "0.25 0 0.2", "0 0 0"
GRAVITIES = {"Earth": "0 0 -9.81", "Moon": "0 0 -1.62", "Mars": "0 0 -3.72", "none": "0 0 0"}


class WorldPanel:
    """What the simulation has around the robots; the choice is one for all browsers.

    Use it in viser's event loop.
    """

    def __init__(self, scene: SceneApi, channel: Channel, send: Send) -> None:
        """Draw the handle into this scene; send requests with `send`."""
        self._send = send
        self._channel = channel
        self._handle = DragHandle(scene, HANDLE)
        self._view = WorldView()
        self._chosen = ""
        self._followed = ""
        self._held: RigidTransform | None = None
        self._wrong = ""

    def build(self, gui: GuiApi) -> None:
        """Create the elements, and serve the browsers' messages."""
        self._drop = FileDrop(self._channel, self._add_file)
        self._channel.on(CHOOSE, self._take_choice)
        self._absent = gui.add_html(note(NO_SIMULATION))
        with gui.add_folder("Things") as things:
            self._list = gui.add_html(note(NO_THINGS))
        with gui.add_folder("Chosen thing") as self._deeds:
            self._build_deeds(gui)
        with gui.add_folder("Gravity", expand_by_default=False) as self._gravities:
            self._gravity = _GravityFields(gui)
        with gui.add_folder("Add", expand_by_default=False) as adding:
            self._fields = _ThingFieldsPanel(gui)
            add = gui.add_button("Add")
        with gui.add_folder("Add a file", expand_by_default=False) as files:
            gui.add_html(note(DROP))
            self._unit = gui.add_dropdown("Unit of STL", tuple(UNITS_M))
            gui.add_button("Choose a file", color="gray")
        with gui.add_folder("Other world", expand_by_default=False) as worlds:
            self._world = gui.add_dropdown("Available", NO_WORLDS)
            load = gui.add_button("Load", hint="replaces everything around the robots")
        self._places = (things, adding, files, worlds)
        self._said = gui.add_html("", visible=False)
        self._gravity.set.on_click(in_order(lambda _: self._try(self._gravity.request)))
        add.on_click(in_order(lambda _: self._try(self._fields.request)))
        load.on_click(in_order(lambda _: self._try(self._opened)))

    def update(self, snapshot: Snapshot) -> None:
        """Show what there is, and pass on where the handle is dragged."""
        self._drop.forget_the_gone()
        view = snapshot.world
        absent = REPLAYED if snapshot.replay else NO_SIMULATION
        say(self._absent, absent if view is None else "", "inherit")
        for place in self._places:
            show(place, view is not None)
        if view is not None and view.answer.number != self._view.answer.number:
            self._wrong = ""
        self._view = view or WorldView()
        things = self._view.things
        chosen = self._chosen if self._chosen in things else ""
        if chosen != self._followed:
            self._followed = chosen
            self._send(LookAtThing(chosen))
        fill(self._list, listed(self._view, chosen))
        show(self._gravities, self._view.gravity is not None)
        self._gravity.show(self._view.gravity)
        worlds = distinct(self._view.worlds) or NO_WORLDS
        if self._world.options != worlds:
            self._world.options = worlds
        show(self._deeds, bool(chosen))
        if chosen:
            self._show_chosen(chosen, things[chosen], properties_of(self._view, chosen))
        else:
            self._handle.hide()
        answer = self._view.answer
        text, is_done = (self._wrong, False) if self._wrong else (answer.text, answer.is_done)
        say(self._said, text, "inherit" if is_done else PROBLEM_COLOUR)

    def choose(self, thing: str) -> None:
        """Choose a thing, if there is one of this name; any thread."""
        self._chosen = thing

    def _build_deeds(self, gui: GuiApi) -> None:
        self._where = gui.add_html("")
        self._position = gui.add_text("Move to", POSITION_M, hint="x y z in the world, in m")
        self._rpy = gui.add_text("Turn to", NO_TURN, hint="roll pitch yaw in rad")
        move = gui.add_button("Move", hint="or drag the arrows and rings in the view")
        self._push_by = gui.add_text("Push to", PUSH_M_S, hint="velocity x y z in m/s")
        self._push = gui.add_button("Push")
        self._properties = _PropertyFields(gui)
        delete = gui.add_button("Delete", color="red")
        move.on_click(in_order(lambda _: self._try(self._move)))
        self._push.on_click(in_order(lambda _: self._try(self._pushed)))
        self._properties.set.on_click(in_order(lambda _: self._try(self._properties.request)))
        delete.on_click(in_order(lambda _: self._try(lambda: RemoveThing(self._chosen))))

    def _show_chosen(self, name: str, thing: Thing, properties: ThingProperties) -> None:
        say(self._where, described(name, thing, properties), "inherit")
        self._properties.show(properties)
        show(self._push_by, thing.can_move)
        show(self._push, thing.can_move)
        pulled, is_dragged = self._handle.pulled(), self._handle.is_dragged
        self._held = self._held if pulled is None else pulled
        # A free thing is put there again and again, as it would fall out of a hand that is still.
        # For a fixed one the world is built anew, so it is moved once, at the end.
        if self._held is not None and (thing.can_move or not is_dragged):
            self._send(PlaceThing(name, self._held))
        if not is_dragged:
            self._held = None
        self._handle.show(thing.pose)

    def _take_choice(self, message: Message, browser: Browser) -> None:
        name = message.text("name")
        self.choose("" if name == self._chosen else name)

    def _try(self, make: Callable[[], WorldRequest]) -> None:
        try:
            request = make()
        except ValueError as error:
            self._wrong = str(error)
            return
        self._wrong = ""
        self._send(request)

    def _move(self) -> WorldRequest:
        return PlaceThing(self._chosen, read_pose(self._position.value, self._rpy.value))

    def _pushed(self) -> WorldRequest:
        x, y, z = read_numbers("velocity", self._push_by.value, ("x", "y", "z"))
        return PushThing(self._chosen, (x, y, z))

    def _opened(self) -> WorldRequest:
        if self._world.value not in self._view.worlds:
            raise ValueError("The simulation names no world that could be loaded.")
        return OpenWorld(self._view.worlds[self._world.value])

    def _add_file(self, file: DroppedFile) -> None:
        metres = UNITS_M[self._unit.value]
        self._try(lambda: AddFile(replace(file, metres=metres), self._fields.pose()))


def rows(things: Mapping[str, Thing], chosen: str) -> str:
    """Return a button for each thing, as HTML."""
    buttons = "".join(
        f'<button type="button" class="arm-thing" data-thing="{escape(name)}" '
        f'aria-pressed="{str(name == chosen).lower()}">{escape(name)}'
        f"<span>{'free' if thing.can_move else 'fixed'}</span></button>"
        for name, thing in things.items()
    )
    return f'<div class="arm-things">{buttons}</div>'


def listed(view: WorldView, chosen: str) -> str:
    """Return the things and the gravity, as HTML."""
    things = rows(view.things, chosen) if view.things else note(NO_THINGS)
    gravity = note(f"Gravity {gravity_words(view.gravity)}") if view.gravity else ""
    return things + gravity


def properties_of(view: WorldView, name: str) -> ThingProperties:
    """Return the properties of a thing, as far as they are known."""
    return view.properties if view.properties.name == name else ThingProperties(name)


def described(name: str, thing: Thing, properties: ThingProperties) -> str:
    """Return where a thing is, rounded to mm and hundredths of a radian, and what it is like."""
    position = " ".join(f"{value:.3f}" for value in thing.pose.position)
    turned = " ".join(f"{value:.2f}" for value in thing.pose.rpy())
    speed = f"; {thing.speed:.2f} m/s" if thing.can_move else ""
    return f"{name}: x y z {position} m, roll pitch yaw {turned} rad{speed}\n{properties.words()}"


class _ThingFieldsPanel:
    """The fields in which a user describes a thing to add to the world."""

    def __init__(self, gui: GuiApi) -> None:
        """Create the elements in the open container."""
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


class _GravityFields:
    """A field for the gravity, and some to choose.

    Attributes:
        set: the button that sets it.
    """

    def __init__(self, gui: GuiApi) -> None:
        """Create the elements in the open container."""
        # A dropdown would not take the same choice again after another one was typed.
        self._like = gui.add_button_group("As on", tuple(GRAVITIES))
        self._gravity = gui.add_text("Gravity", GRAVITIES["Earth"], hint="x y z in m/s²")
        self.set = gui.add_button("Set gravity", hint="resetting puts the world's own back")
        self._like.on_click(in_order(lambda _: self._choose()))
        self._shown: Vector | None = None

    def show(self, gravity: Vector | None) -> None:
        """Show the present gravity, unless it is shown already: the user may be typing."""
        if gravity is not None and gravity != self._shown:
            self._shown = gravity
            self._gravity.value = " ".join(f"{value:.4g}" for value in gravity)

    def request(self) -> SetGravity:
        """Return the request to set what is typed.

        Raises:
            ValueError: it is not a gravity; the message is a sentence.
        """
        x, y, z = read_numbers("gravity", self._gravity.value, ("x", "y", "z"))
        return SetGravity((x, y, z))

    def _choose(self) -> None:
        self._gravity.value = GRAVITIES[self._like.value]


class _PropertyFields:
    """Fields for the properties of the chosen thing.

    Attributes:
        set: the button that sets them.
    """

    def __init__(self, gui: GuiApi) -> None:
        """Create the elements in the open container."""
        self._shown = ThingProperties()
        self._mass = gui.add_text("Mass to", "", hint="in kg; it becomes evenly denser or lighter")
        self._friction = gui.add_text(
            "Friction to", "", hint="coefficient; of two shapes the lower one counts"
        )
        self.set = gui.add_button("Set", hint="mass and friction")
        self.show(self._shown)

    def show(self, properties: ThingProperties) -> None:
        """Show the present properties, unless they are shown already: the user may be typing."""
        show(self._mass, properties.mass_kg is not None)
        show(self._friction, properties.friction is not None)
        show(self.set, bool(properties.words()))
        if properties != self._shown:
            self._shown = properties
            self._mass.value, self._friction.value = _texts(properties)

    def request(self) -> SetProperties:
        """Return the request to set what the user has changed.

        Raises:
            ValueError: that is nothing, or not a number; the message is a sentence.
        """
        mass, friction = _texts(self._shown)
        mass_kg = read_number("mass", self._mass.value) if self._mass.value != mass else None
        other = None
        if self._friction.value != friction:
            other = read_number("friction", self._friction.value)
        if mass_kg is None and other is None:
            raise ValueError("Type another mass or friction first: these are the present ones.")
        return SetProperties(self._shown.name, mass_kg, other)


def _texts(properties: ThingProperties) -> tuple[str, str]:
    """Return mass and friction as the fields show them, "" for what is not known."""
    mass, friction = properties.mass_kg, properties.friction
    return "" if mass is None else f"{mass:.4g}", "" if friction is None else f"{friction:.4g}"
