"""A handle in the 3D view with which the user drags a goal, a thing or the robot itself."""

from dataclasses import dataclass

from viser import SceneApi, TransformControlsEvent, TransformControlsHandle

from arm_node.rigid_transform import RigidTransform

SIZE_PX = 90.0


@dataclass(frozen=True, slots=True)
class HeldHandle:
    """Where in the scene the user holds the handle, and in which of the drags, from 1."""

    pose: RigidTransform
    drag: int


class DragHandle:
    """Arrows and rings of one size on the screen. Use it in viser's event loop.

    While a user drags it, it is where the user has it.

    Attributes:
        held: where it is held; None while nobody drags it.
    """

    def __init__(self, scene: SceneApi, path: str) -> None:
        """Prepare a handle without drawing it; `path` is unique among the scene's nodes."""
        self._scene = scene
        self._path = path
        self._handle: TransformControlsHandle | None = None
        self._shown: RigidTransform | None = None
        self._dragging: set[int | None] = set()
        self._drags = 0
        self._pulled: RigidTransform | None = None
        self.held: HeldHandle | None = None

    @property
    def is_dragged(self) -> bool:
        """Whether a user holds it."""
        return self.held is not None

    def show(self, pose: RigidTransform) -> None:
        """Show it at a pose in the scene, unless it is being dragged."""
        handle = self._handle = self._handle or self._draw()
        if not handle.visible:
            handle.visible = True
        if self.held is None and pose != self._shown:
            self._shown = pose
            x, y, z, w = pose.rotation
            handle.position, handle.wxyz = pose.position, (w, x, y, z)

    def hide(self) -> None:
        """Hide it."""
        if self._handle is not None and self._handle.visible:
            self._handle.visible = False

    def remove(self) -> None:
        """Remove it from the scene."""
        if self._handle is not None:
            self._handle.remove()
            self._handle = None

    def pulled(self) -> RigidTransform | None:
        """Return, once, where in the scene the user has dragged it to."""
        pose, self._pulled = self._pulled, None
        return pose

    def _draw(self) -> TransformControlsHandle:
        handle = self._scene.add_transform_controls(
            self._path, scale=SIZE_PX, fixed=True, depth_test=False, visible=False
        )
        handle.on_update(self._drag)
        return handle

    # A coroutine: viser calls others in a pool of threads, late and in any order.
    async def _drag(self, event: TransformControlsEvent) -> None:
        x, y, z = event.target.position.tolist()
        w, i, j, k = event.target.wxyz.tolist()
        pose = RigidTransform((x, y, z), (i, j, k, w))
        match event.phase:
            case "start":
                self._drags += not self._dragging
                self._dragging.add(event.client_id)
            case "update":
                self._pulled = pose
            case "end":
                # It also comes when the user's browser leaves.
                self._dragging.discard(event.client_id)
                # Afterwards it goes to where what it drags is, also if that is where it was before.
                self._shown = None
        self.held = HeldHandle(pose, self._drags) if self._dragging else None
