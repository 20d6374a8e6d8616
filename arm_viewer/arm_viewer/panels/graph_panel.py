"""The ROS graph: a drawing of nodes and topics."""

from viser import GuiApi

from arm_node.drawing import NodeTopics, node_graph, to_svg
from arm_viewer.panels.panel import show
from arm_viewer.snapshot import Snapshot

WIDTH, HEIGHT = 600.0, 520.0
STYLE = "overflow:auto;background:#fff"


class GraphPanel:
    """A switch, and the window with the graph that it shows."""

    def __init__(self) -> None:
        self._drawn: tuple[NodeTopics, ...] | None = None

    def build(self, gui: GuiApi) -> None:
        """Create the switch and the hidden window."""
        self._shown = gui.add_checkbox("Node graph", False, hint="nodes and topics as in rqt_graph")
        self._window = gui.add_panel(visible=False)
        self._window.float(x=16.0, y=16.0, width=WIDTH, height=HEIGHT)
        with self._window.add_tab("Nodes and topics"):
            self._picture = gui.add_html("")

    def update(self, snapshot: Snapshot) -> None:
        """Redraw a changed graph while it is visible."""
        show(self._window, self._shown.value)
        if self._shown.value and snapshot.nodes != self._drawn:
            self._drawn = snapshot.nodes
            self._picture.content = _picture_html(snapshot.nodes)


def _picture_html(nodes: tuple[NodeTopics, ...]) -> str:
    return f'<div style="{STYLE}">{to_svg(node_graph(nodes))}</div>'
