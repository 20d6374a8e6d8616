"""The tab of the world: its things, a handle to move one, and what can be added or loaded."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from html import escape

from viser import GuiApi, GuiHtmlHandle, SceneApi

from arm_node.rigid_transform import RigidTransform
from arm_viewer.channel import Browser, Channel, Message
from arm_viewer.panels.file_drop import FileDrop
from arm_viewer.panels.panel import PROBLEM_COLOUR, distinct, in_order, note, show
from arm_viewer.panels.property_fields import GravityFields, PropertyFields
from arm_viewer.panels.thing_fields import POSITION_M, ThingFieldsPanel
from arm_viewer.requests import Send
from arm_viewer.scene.drag_handle import DragHandle
from arm_viewer.snapshot import Snapshot
from arm_viewer.world.dropped_file import DroppedFile
from arm_viewer.world.shape_fields import read_numbers, read_pose
from arm_viewer.world.world_view import Thing, ThingProperties, WorldView, gravity_words
from arm_viewer.world_requests import (
    AddFile,
    LookAtThing,
    OpenWorld,
    PlaceThing,
    PushThing,
    RemoveThing,
    WorldRequest,
)

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


class WorldPanel:
    """What the simulation has around the robots; the choice is one for all browsers."""

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
            self._gravity = GravityFields(gui)
        with gui.add_folder("Add", expand_by_default=False) as adding:
            self._fields = ThingFieldsPanel(gui)
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
        self._set(self._absent, note(REPLAYED if snapshot.replay else NO_SIMULATION))
        show(self._absent, view is None)
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
        self._set(self._list, listed(self._view, chosen))
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
        self._set(self._said, note(text, "inherit" if is_done else PROBLEM_COLOUR))
        show(self._said, bool(text))

    def choose(self, thing: str) -> None:
        """Choose a thing, if there is one of this name; any thread."""
        self._chosen = thing

    def _build_deeds(self, gui: GuiApi) -> None:
        self._where = gui.add_html("")
        self._position = gui.add_text("Move to", POSITION_M, hint="x y z in the world, in m")
        self._rpy = gui.add_text("Turn to", "0 0 0", hint="roll pitch yaw in rad")
        move = gui.add_button("Move", hint="or drag the arrows and rings in the view")
        self._push_by = gui.add_text("Push to", PUSH_M_S, hint="velocity x y z in m/s")
        self._push = gui.add_button("Push")
        self._properties = PropertyFields(gui)
        delete = gui.add_button("Delete", color="red")
        move.on_click(in_order(lambda _: self._try(self._move)))
        self._push.on_click(in_order(lambda _: self._try(self._pushed)))
        self._properties.set.on_click(in_order(lambda _: self._try(self._properties.request)))
        delete.on_click(in_order(lambda _: self._try(lambda: RemoveThing(self._chosen))))

    def _show_chosen(self, name: str, thing: Thing, properties: ThingProperties) -> None:
        self._set(self._where, note(described(name, thing, properties)))
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

    def _set(self, element: GuiHtmlHandle, content: str) -> None:
        if element.content != content:
            element.content = content

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
