"""A handle of the 3D view, while users drag it."""

import asyncio
from types import SimpleNamespace

import numpy as np

from arm_node.rigid_transform import RigidTransform
from arm_viewer.scene.drag_handle import DragHandle, HeldHandle


class DrawnHandle:
    """Takes the place of viser's handle, and is dragged as by a browser."""

    def __init__(self) -> None:
        self.visible = False
        self.position = np.zeros(3)
        self.wxyz = np.array([1.0, 0.0, 0.0, 0.0])

    def __setattr__(self, name: str, value: object) -> None:
        # As viser does.
        super().__setattr__(name, np.array(value) if name in ("position", "wxyz") else value)

    def on_update(self, callback) -> None:
        self._callback = callback

    def drag(self, phase: str, x: float, client_id: int = 0) -> None:
        self.position = np.array([x, 0.0, 0.0])
        event = SimpleNamespace(phase=phase, client_id=client_id, target=self)
        asyncio.run(self._callback(event))


def shown() -> tuple[DragHandle, DrawnHandle]:
    """Return a handle that is shown at the origin, and what stands in the scene."""
    drawn = DrawnHandle()
    scene = SimpleNamespace(add_transform_controls=lambda *_, **__: drawn)
    handle = DragHandle(scene, "tip")
    handle.show(RigidTransform())
    return handle, drawn


def test_it_is_held_where_the_user_has_it_until_it_is_let_go():
    handle, drawn = shown()
    assert handle.held is None
    drawn.drag("start", 0.0)
    assert handle.held == HeldHandle(RigidTransform(), 1)
    drawn.drag("update", 0.2)
    assert handle.held == HeldHandle(RigidTransform((0.2, 0.0, 0.0)), 1)
    drawn.drag("end", 0.2)
    assert handle.held is None
    drawn.drag("start", 0.2)
    assert handle.held is not None
    assert handle.held.drag == 2


def test_it_follows_the_tip_only_while_nobody_holds_it():
    handle, drawn = shown()
    drawn.drag("start", 0.0)
    drawn.drag("update", 0.2)
    handle.show(RigidTransform((0.1, 0.0, 0.0)))
    assert drawn.position[0] == 0.2
    drawn.drag("end", 0.2)
    handle.show(RigidTransform((0.1, 0.0, 0.0)))
    assert drawn.position[0] == 0.1


def test_of_two_browsers_the_last_one_lets_it_go():
    handle, drawn = shown()
    drawn.drag("start", 0.0, client_id=1)
    drawn.drag("start", 0.0, client_id=2)
    drawn.drag("end", 0.1, client_id=1)
    assert handle.held == HeldHandle(RigidTransform((0.1, 0.0, 0.0)), 1)
    drawn.drag("end", 0.1, client_id=2)
    assert handle.held is None


def test_where_it_was_pulled_to_is_said_once():
    handle, drawn = shown()
    drawn.drag("start", 0.0)
    assert handle.pulled() is None
    drawn.drag("update", 0.2)
    drawn.drag("end", 0.2)
    assert handle.pulled() == RigidTransform((0.2, 0.0, 0.0))
    assert handle.pulled() is None
