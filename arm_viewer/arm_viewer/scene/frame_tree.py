"""The frames of /tf as nodes of the 3D view, each below its parent."""

from collections.abc import Mapping

from viser import FrameHandle, SceneApi

from arm_viewer.snapshot import Transform

ROOT = "/frames"
AXES_LENGTH, AXES_RADIUS = 0.05, 0.002


class FrameTree:
    """Keeps the scene's frames where the transforms say; use it in the page's thread.

    Shapes hang below their frame (`path`), so only what moves is sent.
    """

    def __init__(self, scene: SceneApi) -> None:
        """Start without frames."""
        self._scene = scene
        self._shown: Mapping[str, Transform] = {}
        self._parents: dict[str, str] = {}
        self._handles: dict[str, FrameHandle] = {}
        self._paths: dict[str, str] = {}
        self._axes = False
        self.generation = 0
        """Rises whenever the tree is another one: what hung below its frames is gone then."""

    def path(self, frame: str) -> str | None:
        """Return the scene's name of a frame, None where there is none."""
        return self._paths.get(frame)

    def update(self, transforms: Mapping[str, Transform]) -> None:
        """Move the frames to where they are; make the tree anew where it has changed."""
        if transforms is self._shown:
            return
        parents = {child: transform.parent for child, transform in transforms.items()}
        if parents != self._parents:
            self._rebuild(transforms, parents)
        for child, transform in transforms.items():
            if transform != self._shown.get(child) and child in self._handles:
                handle = self._handles[child]
                x, y, z, w = transform.rotation
                handle.wxyz, handle.position = (w, x, y, z), transform.position
        self._shown = transforms

    def show_axes(self, shown: bool) -> None:
        """Show or hide the axes of all frames."""
        if shown != self._axes:
            self._axes = shown
            for handle in self._handles.values():
                handle.show_axes = shown

    def _rebuild(self, transforms: Mapping[str, Transform], parents: dict[str, str]) -> None:
        self._scene.remove_by_name(ROOT)
        self._handles.clear()
        self._shown = {}
        self._parents = parents
        self._paths = _paths(parents)
        self.generation += 1
        for frame, path in self._paths.items():
            self._handles[frame] = self._scene.add_frame(
                path,
                show_axes=self._axes,
                axes_length=AXES_LENGTH,
                axes_radius=AXES_RADIUS,
                origin_radius=AXES_RADIUS * 1.5,
            )


def _paths(parents: Mapping[str, str]) -> dict[str, str]:
    """Return the scene's name of every frame, parents first; frames in a circle are left out."""
    children: dict[str, list[str]] = {}
    for child, parent in parents.items():
        children.setdefault(parent, []).append(child)
    waiting = [(frame, f"{ROOT}/{_word(frame)}") for frame in children if frame not in parents]
    paths: dict[str, str] = {}
    while waiting:
        frame, path = waiting.pop()
        paths[frame] = path
        waiting.extend((child, f"{path}/{_word(child)}") for child in children.get(frame, ()))
    return paths


def _word(frame: str) -> str:
    # A slash in a frame's name must not make a level of the scene's tree.
    return frame.replace("/", "\N{DIVISION SLASH}")
