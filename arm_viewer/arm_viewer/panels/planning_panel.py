"""The tab with motion planning, which is there as long as a move_group is."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from viser import GuiApi, GuiTabHandle, SceneApi

from arm_viewer.panels.panel import note, show
from arm_viewer.requests import Send
from arm_viewer.scene.frames import Frames
from arm_viewer.snapshot import Snapshot

if TYPE_CHECKING:
    from arm_viewer.panels.motion_panel import MotionPanel

TITLE = "Planning"
GONE = "move_group has ended; this continues when it returns."


class PlanningPanel:
    """A motion panel for each move_group.

    The tab appears with the first one. It stays after the last one and says that it has ended.
    """

    def __init__(
        self, scene: SceneApi, frames: Frames, send: Send, add_tab: Callable[[str], GuiTabHandle]
    ) -> None:
        """Draw into this scene, below these frames; send requests with `send`."""
        self._scene = scene
        self._frames = frames
        self._send = send
        self._add_tab = add_tab
        self._tab: GuiTabHandle | None = None
        self._panels: dict[str, MotionPanel] = {}

    def build(self, gui: GuiApi) -> None:
        """Keep the interface for the tab."""
        self._gui = gui

    def update(self, snapshot: Snapshot) -> None:
        """Show the move_groups."""
        for namespace in [n for n, p in self._panels.items() if not p.is_for(snapshot)]:
            self._panels.pop(namespace).remove()
        for namespace in snapshot.planning:
            if namespace not in self._panels:
                self._panels[namespace] = self._panel(snapshot, namespace)
        for panel in self._panels.values():
            panel.update(snapshot)
        if self._tab is not None:
            show(self._gone, not self._panels)

    def _panel(self, snapshot: Snapshot, namespace: str) -> "MotionPanel":
        # Imported with the first move_group, because most pages have none.
        from arm_viewer.panels.motion_panel import MotionPanel

        if self._tab is None:
            self._tab = self._add_tab(TITLE)
            with self._tab:
                self._gone = self._gui.add_html(note(GONE), visible=False)
        with self._tab:
            view = snapshot.planning[namespace]
            return MotionPanel(self._gui, self._scene, self._frames, self._send, view)
