"""The topics: type, who has them, and how often they are published."""

import math
from html import escape

from viser import GuiApi

from arm_viewer.requests import MeasureRates, Send
from arm_viewer.snapshot import Snapshot, Topic


class TopicPanel:
    """A table of all topics; rates where they are asked for."""

    def __init__(self, send: Send) -> None:
        """Send there whether rates are wanted."""
        self._send = send
        self._shown: tuple[Topic, ...] | None = None

    def build(self, gui: GuiApi) -> None:
        """Make the switch and the table."""
        with gui.add_folder("Topics"):
            measured = gui.add_checkbox(
                "Rates", False, hint="measured by a subscription to every topic, images too"
            )
            measured.on_update(lambda _: self._send(MeasureRates(measured.value)))
            self._table = gui.add_html("")

    def update(self, snapshot: Snapshot) -> None:
        """Show what has changed."""
        if snapshot.topics != self._shown:
            self._shown = snapshot.topics
            self._table.content = _html(snapshot.topics)


def _html(topics: tuple[Topic, ...]) -> str:
    rows = "".join(_row(topic) for topic in topics) or "<tr><td>No topic is there.</td></tr>"
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
