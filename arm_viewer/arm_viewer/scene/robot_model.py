"""One robot in the 3D view."""

from collections.abc import Collection, Mapping

from viser import MeshHandle, SceneApi, SceneNodeHandle

from arm_description.robot import Link, Robot
from arm_viewer.scene.frames import Frames
from arm_viewer.scene.link_layers import (
    draw_collisions,
    draw_inertia,
    draw_mass,
    draw_visuals,
)

VISUAL, COLLISION, MASS, INERTIA = "visual", "collision", "mass", "inertia"
LAYERS = {
    VISUAL: draw_visuals,
    COLLISION: draw_collisions,
    MASS: draw_mass,
    INERTIA: draw_inertia,
}
SEEN_THROUGH = 0.4
"""The most that a link covers of what lies inside it."""


class RobotModel:
    """Draws a robot layer by layer, each when it is first asked for, in viser's event loop."""

    def __init__(
        self, scene: SceneApi, frames: Frames, name: str, robot: Robot, places: Mapping[str, str]
    ) -> None:
        """Prepare a robot; nothing is drawn yet.

        Args:
            scene: where.
            frames: of this scene.
            name: tells this robot from others, in the names of the scene's nodes.
            robot: what to draw.
            places: the frame of each link.
        """
        self._scene = scene
        self._frames = frames
        self._name = name
        self._robot = robot
        self._places = places
        self._problems: dict[str, None] = {}
        self._drawn: dict[str, list[SceneNodeHandle]] = {}
        self._opacities: list[tuple[MeshHandle, float | None]] = []
        self._seen_through = False

    @property
    def problems(self) -> Collection[str]:
        """What of the links could not be drawn so far, in lines."""
        return self._problems.keys()

    def show(self, layers: Collection[str], seen_through: bool) -> None:
        """Show these layers and hide the others.

        Args:
            layers: of LAYERS.
            seen_through: whether what lies inside the links is to be seen.
        """
        for layer in LAYERS:
            if layer in layers and layer not in self._drawn:
                self._draw(layer)
            for handle in self._drawn.get(layer, ()):
                handle.visible = layer in layers
        if seen_through != self._seen_through:
            self._seen_through = seen_through
            self._set_opacities()

    def remove(self) -> None:
        """Take the robot out of the scene; its frames stay."""
        for handles in self._drawn.values():
            for handle in handles:
                handle.remove()

    def _draw(self, layer: str) -> None:
        handles = [
            handle
            for link in self._robot.links
            for handle in LAYERS[layer](self._scene, self._path(link), link, self._complain)
        ]
        self._drawn[layer] = handles
        if layer == VISUAL:
            meshes = [handle for handle in handles if isinstance(handle, MeshHandle)]
            self._opacities = [(mesh, mesh.opacity) for mesh in meshes]
            self._set_opacities()

    def _path(self, link: Link) -> str:
        return f"{self._frames.path(self._places[link.name])}/{self._name}"

    def _complain(self, problem: str) -> None:
        # Once for a mesh that is both seen and touched.
        self._problems[problem] = None

    def _set_opacities(self) -> None:
        for mesh, own in self._opacities:
            opacity = min(own or 1.0, SEEN_THROUGH) if self._seen_through else own
            if mesh.opacity != opacity:
                mesh.opacity = opacity
