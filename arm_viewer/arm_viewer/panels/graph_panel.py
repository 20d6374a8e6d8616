"""Nodes and topics as a picture, in a window of its own."""

from viser import GuiApi

from arm_viewer.drawing.node_graph import NodeTopics, node_graph
from arm_viewer.drawing.svg import to_svg
from arm_viewer.snapshot import Snapshot

WIDTH, HEIGHT = 600.0, 520.0
DARK = "overflow:auto;background:#fff;filter:invert(0.88) hue-rotate(180deg)"
"""The picture is made for paper: light becomes dark, and colours stay what they are."""


class GraphPanel:
    """A switch, and the window that it shows."""

    def __init__(self) -> None:
        self._drawn: tuple[NodeTopics, ...] | None = None

    def build(self, gui: GuiApi) -> None:
        """Make the switch and the hidden window."""
        self._shown = gui.add_checkbox("Node graph", False, hint="what rqt_graph shows")
        self._window = gui.add_panel(visible=False)
        self._window.float(x=16.0, y=16.0, width=WIDTH, height=HEIGHT)
        with self._window.add_tab("Nodes and topics"):
            self._picture = gui.add_html("")

    def update(self, snapshot: Snapshot) -> None:
        """Draw what has changed, while it is to be seen."""
        if self._shown.value != self._window.visible:
            self._window.visible = self._shown.value
        if self._shown.value and snapshot.nodes != self._drawn:
            self._drawn = snapshot.nodes
            self._picture.content = _html(snapshot.nodes)


def _html(nodes: tuple[NodeTopics, ...]) -> str:
    return f'<div style="{DARK}">{to_svg(node_graph(nodes))}</div>'
