"""The ROS graph: a drawing of nodes and topics, and a table of topics."""

import math
from html import escape

from viser import GuiApi

from arm_node.drawing import NodeTopics, node_graph, to_svg
from arm_viewer.requests import MeasureRates, Send
from arm_viewer.snapshot import Snapshot, Topic

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
        if self._shown.value != self._window.visible:
            self._window.visible = self._shown.value
        if self._shown.value and snapshot.nodes != self._drawn:
            self._drawn = snapshot.nodes
            self._picture.content = _picture_html(snapshot.nodes)


def _picture_html(nodes: tuple[NodeTopics, ...]) -> str:
    return f'<div style="{STYLE}">{to_svg(node_graph(nodes))}</div>'


class TopicPanel:
    """A table of all topics, with their rates on request."""

    def __init__(self, send: Send) -> None:
        """Send with `send` whether rates are wanted."""
        self._send = send
        self._shown: tuple[Topic, ...] | None = None

    def build(self, gui: GuiApi) -> None:
        """Create the switch and the table."""
        with gui.add_folder("Topics"):
            measured = gui.add_checkbox(
                "Rates", False, hint="measured by subscribing to every topic, including images"
            )
            measured.on_update(lambda _: self._send(MeasureRates(measured.value)))
            self._table = gui.add_html("")

    def update(self, snapshot: Snapshot) -> None:
        """Update a changed table."""
        if snapshot.topics != self._shown:
            self._shown = snapshot.topics
            self._table.content = _table_html(snapshot.topics)


def _table_html(topics: tuple[Topic, ...]) -> str:
    rows = "".join(_row(topic) for topic in topics) or "<tr><td>There are no topics.</td></tr>"
    return (
        '<table style="font-size:0.75rem;margin:0.25em 0.75em;width:calc(100% - 1.5em);'
        f'font-variant-numeric:tabular-nums;border-collapse:collapse">{rows}</table>'
    )


def _row(topic: Topic) -> str:
    rate = "" if math.isnan(topic.rate_hz) else f"{topic.rate_hz:.1f} Hz"
    types = ", ".join(topic.types)
    return (
        '<tr style="border-top:1px solid rgba(128,128,128,0.25)">'
        f'<td style="overflow-wrap:anywhere;padding:0.2em 0">{escape(topic.name)}<br/>'
        f'<span style="opacity:0.6">{escape(types)} · {topic.publishers} pub, '
        f"{topic.subscriptions} sub</span></td>"
        f'<td style="text-align:right;white-space:nowrap;vertical-align:top">{rate}</td></tr>'
    )
