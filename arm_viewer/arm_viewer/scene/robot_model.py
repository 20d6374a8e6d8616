"""One robot in the 3D view."""

from collections.abc import Collection, Mapping

import numpy as np
from viser import MeshHandle, SceneApi, SceneNodeHandle

from arm_description.errors import DescriptionError
from arm_description.mesh.data import MeshData
from arm_description.urdf.robot import Geometry, Link, Robot
from arm_description.view_fitting import Body, body_of
from arm_node.rigid_transform import rotated
from arm_viewer.scene.frames import Frames
from arm_viewer.scene.link_layers import (
    draw_collisions,
    draw_inertia,
    draw_mass,
    draw_visuals,
)
from arm_viewer.scene.triangles import triangles

VISUAL, COLLISION, MASS, INERTIA = "visual", "collision", "mass", "inertia"
LAYERS = {
    VISUAL: draw_visuals,
    COLLISION: draw_collisions,
    MASS: draw_mass,
    INERTIA: draw_inertia,
}
TRANSPARENT_OPACITY = 0.4
"""Opacity of links while something inside them is shown."""
GREY = (172, 176, 180)
"""Colour of a robot with unknown joint positions."""


class RobotModel:
    """Draws a robot's layers, each when it is first shown; use it in viser's event loop."""

    def __init__(
        self, scene: SceneApi, frames: Frames, name: str, robot: Robot, places: Mapping[str, str]
    ) -> None:
        """Prepare a robot without drawing it; its scene nodes get this unique name."""
        self._scene = scene
        self._frames = frames
        self._name = name
        self._robot = robot
        self._places = places
        self._problems: dict[str, None] = {}
        self._drawn: dict[str, list[SceneNodeHandle]] = {}
        self._opacities: list[tuple[MeshHandle, float | None]] = []
        self._transparent = False
        self._colours: list[tuple[MeshHandle, tuple[int, int, int]]] = []
        self._grey = False

    @property
    def problems(self) -> Collection[str]:
        """One line for each part of a link that could not be drawn."""
        return self._problems.keys()

    def show(self, layers: Collection[str], transparent: bool, grey: bool = False) -> None:
        """Show these LAYERS and hide the others; transparent links show what is inside them."""
        for layer in LAYERS:
            if layer in layers and layer not in self._drawn:
                self._draw(layer)
            for handle in self._drawn.get(layer, ()):
                if handle.visible != (layer in layers):
                    handle.visible = layer in layers
        if transparent != self._transparent:
            self._transparent = transparent
            self._set_opacities()
        if grey != self._grey:
            self._grey = grey
            self._set_colours()

    def bodies(self) -> list[Body]:
        """Return the bodies of the links at the present poses of their frames."""
        bodies: list[Body] = []
        for link in self._robot.links:
            pose = self._frames.known.get(self._places[link.name])
            if pose is None:
                continue
            for visual in link.visuals or link.collisions:
                for part in _parts(visual.geometry):
                    origin = visual.origin.matrix()
                    points = part.vertices @ origin[:3, :3].T + origin[:3, 3]
                    low, high = points.min(axis=0), points.max(axis=0)
                    corners = body_of(np.array([low, high])).corners.tolist()
                    placed = [rotated(pose.rotation, (x, y, z)) for x, y, z in corners]
                    bodies.append(body_of(np.array(placed) + pose.position))
        return bodies

    def remove(self) -> None:
        """Remove the robot from the scene, but not its frames."""
        for handles in self._drawn.values():
            for handle in handles:
                handle.remove()

    def _draw(self, layer: str) -> None:
        handles = [
            handle
            for link in self._robot.links
            for handle in LAYERS[layer](self._scene, self._path(link), link, self._report_problem)
        ]
        self._drawn[layer] = handles
        if layer == VISUAL:
            meshes = [handle for handle in handles if isinstance(handle, MeshHandle)]
            self._opacities = [(mesh, mesh.opacity) for mesh in meshes]
            self._set_opacities()
            self._colours = [(mesh, mesh.color) for mesh in meshes]
            self._set_colours()

    def _path(self, link: Link) -> str:
        return f"{self._frames.path(self._places[link.name])}/{self._name}"

    def _report_problem(self, problem: str) -> None:
        # A dict key, so that a mesh used for both visual and collision is reported once.
        self._problems[problem] = None

    def _set_colours(self) -> None:
        for mesh, own in self._colours:
            colour = GREY if self._grey else own
            if mesh.color != colour:
                mesh.color = colour

    def _set_opacities(self) -> None:
        for mesh, own in self._opacities:
            opacity = min(own or 1.0, TRANSPARENT_OPACITY) if self._transparent else own
            if mesh.opacity != opacity:
                mesh.opacity = opacity


def _parts(geometry: Geometry) -> tuple[MeshData, ...]:
    try:
        return triangles(geometry)
    except DescriptionError:
        # `link_layers` reports meshes that cannot be drawn.
        return ()
