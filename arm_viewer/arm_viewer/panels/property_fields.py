"""Fields for the gravity of a simulation, and for mass and friction of a thing."""

from viser import GuiApi

from arm_node.rigid_transform import Vector
from arm_viewer.panels.panel import in_order, show
from arm_viewer.world.shape_fields import read_number, read_numbers
from arm_viewer.world.world_view import ThingProperties
from arm_viewer.world_requests import SetGravity, SetProperties

GRAVITIES = {"Earth": "0 0 -9.81", "Moon": "0 0 -1.62", "Mars": "0 0 -3.72", "none": "0 0 0"}


class GravityFields:
    """A field for the gravity, and some to choose; use it in viser's event loop.

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


class PropertyFields:
    """Fields for the properties of the chosen thing; use it in viser's event loop.

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
