"""The first view in a browser: the robots and nearby objects fill it."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from viser import CameraHandle, ClientHandle, ViserServer

from arm_description.view_fitting import Body, View, fit_view

CAMERA_POSITION, CAMERA_TARGET = (0.75, -0.75, 0.55), (0.0, 0.0, 0.2)
CAMERA_FOV_RAD = 0.8
"""Until there are robots."""
SETTLED_S = 1.0
"""Robots and worlds arrive in several messages; the view waits until nothing new has arrived."""
MAX_POSITIONS = 20
SAME = 0.02
"""A camera within this fraction of its distance from where the page put it was not moved."""
Array = NDArray[np.float64]
TOUCH = 1e-9


class Obstacles:
    """Oriented boxes, each solid or containing triangles, that block lines of sight.

    Args:
        rotations: rotations from the boxes' frames, shape (m, 3, 3).
        centres: centres in m, shape (m, 3).
        halves: half sides in m, shape (m, 3).
        triangles: for each box its triangles in the scene's frame (t, 3, 3); empty for a solid box.
    """

    def __init__(
        self, rotations: Array, centres: Array, halves: Array, triangles: Sequence[Array]
    ) -> None:
        self._rotations = rotations.reshape(-1, 3, 3)
        self._centres = centres.reshape(-1, 3)
        self._halves = halves.reshape(-1, 3)
        self._triangles = triangles

    def block(self, starts: Array, ends: Array) -> NDArray[np.bool_]:
        """Return whether the line from each start (n, 3) to its end (n, 3) is blocked, (n,)."""
        if not len(self._centres):
            return np.zeros(len(starts), dtype=bool)
        hit = self._boxes_hit(starts, ends)
        solid = np.array([not len(faces) for faces in self._triangles])
        blocked = np.zeros(len(starts), dtype=np.bool_)
        blocked |= hit[solid].any(axis=0)
        for box in np.flatnonzero(~solid & hit.any(axis=1)).tolist():
            lines = np.flatnonzero(np.logical_and(hit[box], ~blocked))
            if len(lines):
                blocked[lines] = _cross(self._triangles[box], starts[lines], ends[lines])
        return blocked

    def _boxes_hit(self, starts: Array, ends: Array) -> NDArray[np.bool_]:
        """Return which lines intersect which boxes, shape (m, n)."""
        begin = np.einsum("mji,mnj->mni", self._rotations, starts - self._centres[:, None])
        line = np.einsum("mji,nj->mni", self._rotations, ends - starts)
        line = np.where(np.abs(line) < TOUCH, TOUCH, line)
        halves = self._halves[:, None]
        near, far = (-halves - begin) / line, (halves - begin) / line
        enter = np.minimum(near, far).max(axis=-1)
        leave = np.maximum(near, far).min(axis=-1)
        return (enter < leave) & (leave > 0.0) & (enter < 1.0)


def _cross(triangles: Array, starts: Array, ends: Array) -> NDArray[np.bool_]:
    """Return which lines cross any of the triangles, by Moeller and Trumbore's method."""
    corner, first, second = (
        triangles[:, 0],
        triangles[:, 1] - triangles[:, 0],
        triangles[:, 2] - triangles[:, 0],
    )
    crossed = np.zeros(len(starts), dtype=bool)
    for i, (start, line) in enumerate(zip(starts, ends - starts, strict=True)):
        normal = np.cross(line, second)
        determinant = np.einsum("ti,ti->t", first, normal)
        flat = np.abs(determinant) < TOUCH
        inverse = 1.0 / np.where(flat, 1.0, determinant)
        offset = start - corner
        u = np.einsum("ti,ti->t", offset, normal) * inverse
        across = np.cross(offset, first)
        v = across @ line * inverse
        at = np.einsum("ti,ti->t", second, across) * inverse
        inside = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (at > 0.0) & (at < 1.0)
        crossed[i] = bool((inside & ~flat).any())
    return crossed


@dataclass(frozen=True, slots=True)
class Contents:
    """The contents of the scene.

    Attributes:
        robots: bodies of robots.
        things: other bodies, without the ground.
        obstacles: the other bodies as obstacles to the view.
    """

    robots: list[Body]
    things: list[Body]
    obstacles: Obstacles


@dataclass(frozen=True, slots=True)
class _Placed:
    """The pose of a browser's camera, and the contents and aspect ratio that it was fitted to."""

    version: int
    aspect: float
    view: View
    before: tuple[tuple[float, float, float], ...] = ()
    """Earlier positions, because a browser's report may have crossed a move."""

    def is_outdated(self, version: int, aspect: float) -> bool:
        # The aspect ratio changes when the panels are laid out after the browser's first report.
        return version != self.version or abs(aspect - self.aspect) > SAME * self.aspect


class FirstView:
    """Moves each browser's camera until its user does; use it in viser's event loop.

    A browser whose address names a view keeps that one: viser's client reads it.
    """

    def __init__(self, server: ViserServer) -> None:
        self._server = server
        self._key: object = None
        self._changed_s = 0.0
        self._version = 0
        self._contents: Contents | None = None
        self._placed: dict[int, _Placed] = {}
        self._chosen: View | None = None
        self._initial = [tuple(server.initial_camera.position)]
        self._met: set[int] = set()
        self._own: set[int] = set()
        """Browsers whose address names a view."""

    def is_due(self, key: object, now_s: float) -> bool:
        """Return whether the contents, which `key` identifies, have changed and then settled."""
        if key != self._key:
            self._key, self._changed_s, self._contents = key, now_s, None
        return self._contents is None and now_s - self._changed_s > SETTLED_S

    def set_contents(self, contents: Contents) -> None:
        """Set the contents that the views show from now on."""
        self._contents = contents
        self._version += 1
        view = self._fitted(1.0)
        if view is not None:
            camera = self._server.initial_camera
            camera.position, camera.look_at = view.position, view.target
            self._initial = [*self._initial, view.position][-MAX_POSITIONS:]

    def fit_again(self, client_id: int) -> None:
        """Forget that a user has moved the camera."""
        self._placed.pop(client_id, None)
        self._own.discard(client_id)
        self._key = None
        self._chosen = None

    def choose(self, view: View, client_ids: Iterable[int] = ()) -> None:
        """Use this view until `fit_again`; the cameras of these browsers move there in any case."""
        self._chosen = view
        self._version += 1
        for client_id in client_ids:
            self._placed.pop(client_id, None)
            self._own.discard(client_id)

    def current(self, client_id: int) -> View | None:
        """Return where a browser's camera is; None if the browser is gone."""
        client = self._server.get_clients().get(client_id)
        if client is None:
            return None
        x, y, z = client.camera.position.tolist()
        a, b, c = client.camera.look_at.tolist()
        return View((x, y, z), (a, b, c))

    def update(self) -> None:
        """Move the cameras that no user has moved."""
        if self._contents is None:
            return
        clients = self._server.get_clients()
        self._placed = {i: placed for i, placed in self._placed.items() if i in clients}
        self._meet(clients)
        for client_id, client in clients.items():
            if client_id in self._own:
                continue
            aspect, placed = client.camera.aspect, self._placed.get(client_id)
            if placed is None or (
                placed.is_outdated(self._version, aspect) and _is_at(client.camera, placed)
            ):
                view = self._fitted(aspect)
                if view is not None:
                    x, y, z = client.camera.position.tolist()
                    before = (*(placed.before if placed else ()), (x, y, z))[-MAX_POSITIONS:]
                    self._placed[client_id] = _Placed(self._version, aspect, view, before)
                    with client.atomic():
                        client.camera.position = view.position
                        client.camera.look_at = view.target

    def _meet(self, clients: Mapping[int, ClientHandle]) -> None:
        """Find out which new browsers have a view of their own."""
        for client_id in clients.keys() - self._met:
            position = np.asarray(clients[client_id].camera.position)
            away = np.linalg.norm(np.array(self._initial) - position, axis=1)
            if away.min() > SAME * np.linalg.norm(position):
                self._own.add(client_id)
        self._met = set(clients)
        self._own &= self._met

    def _fitted(self, aspect: float) -> View | None:
        if self._contents is None:
            return None
        if self._chosen is not None:
            return self._chosen
        contents = self._contents
        return fit_view(
            contents.robots, contents.things, contents.obstacles.block, CAMERA_FOV_RAD, aspect
        )


def _is_at(camera: CameraHandle, placed: _Placed) -> bool:
    """Return whether a camera is at a position where the page has put it, now or earlier."""
    view = placed.view
    distance = float(np.linalg.norm(np.subtract(view.position, view.target)))
    places = np.array([view.position, *placed.before])
    moved = np.linalg.norm(places - camera.position, axis=1)
    return bool(moved.min() <= SAME * distance)
