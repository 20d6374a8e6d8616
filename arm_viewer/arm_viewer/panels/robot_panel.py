"""What of the robots is shown: the switches, and the robots themselves in the 3D view."""

from viser import GuiApi, SceneApi

from arm_viewer.scene.frame_tree import FrameTree
from arm_viewer.snapshot import Snapshot


class RobotPanel:
    """Keeps the robots of the 3D view, and shows what the switches say."""

    def __init__(self, scene: SceneApi) -> None:
        """Draw into this scene."""
        self._frames = FrameTree(scene)

    def build(self, gui: GuiApi) -> None:
        """Make the switches."""
        self._show_frames = gui.add_checkbox("Frames", False)

    def update(self, snapshot: Snapshot) -> None:
        """Move the frames."""
        self._frames.update(snapshot.transforms)
        self._frames.show_axes(self._show_frames.value)
