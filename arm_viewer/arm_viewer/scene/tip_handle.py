"""The handle at a group's tip, with which the user drags the goal."""

from viser import SceneApi, TransformControlsHandle

from arm_node.rigid_transform import RigidTransform
from arm_viewer.scene.frames import node_name

SIZE_PX = 90.0


class TipHandle:
    """Arrows and rings of one size on the screen. Use it in viser's event loop.

    While the user drags it, it is where the user has it.
    """

    def __init__(self, scene: SceneApi, name: str) -> None:
        """Prepare a handle without drawing it; `name` is unique among the scene's nodes."""
        self._scene = scene
        self._path = f"/planning/{node_name(name)}"
        self._handle: TransformControlsHandle | None = None
        self._shown: RigidTransform | None = None
        self._is_dragged = False
        self._pulled: RigidTransform | None = None

    def show(self, pose: RigidTransform) -> None:
        """Show it at a pose in the scene, unless it is being dragged."""
        handle = self._handle = self._handle or self._draw()
        if not handle.visible:
            handle.visible = True
        if not self._is_dragged and pose != self._shown:
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
        handle.on_update(lambda _: self._pull(handle))
        handle.on_drag_start(lambda _: self._drag(True))
        handle.on_drag_end(lambda _: self._drag(False))
        return handle

    # Called in viser's threads.

    def _pull(self, handle: TransformControlsHandle) -> None:
        x, y, z = handle.position.tolist()
        w, i, j, k = handle.wxyz.tolist()
        self._pulled = RigidTransform((x, y, z), (i, j, k, w))

    def _drag(self, is_dragged: bool) -> None:
        self._is_dragged = is_dragged
        # Afterwards it goes to the goal's tip, also if that is where it was before.
        self._shown = None
