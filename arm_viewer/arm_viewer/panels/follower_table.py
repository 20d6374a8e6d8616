"""The joints that follow others: shown, but not to be moved."""

import math
from collections.abc import Iterable, Mapping
from html import escape

from viser import GuiApi

from arm_description.robot import Joint
from arm_viewer.snapshot import JointReading

NUMBER = "text-align:right;vertical-align:top;white-space:nowrap;padding-left:1em"


class FollowerTable:
    """A line for each mimicking joint: its leader, and where it is."""

    def __init__(self, gui: GuiApi, joints: Iterable[Joint]) -> None:
        """Make the table, inside the container that is open; of no followers nothing is seen."""
        self._leaders = {j.name: j.mimic.joint for j in joints if j.mimic is not None}
        self._table = gui.add_html("", visible=bool(self._leaders))
        self._shown = ""

    def update(self, readings: Mapping[str, JointReading]) -> None:
        """Show where the followers are."""
        rows = "".join(
            f'<tr><td>{escape(name)}<span style="opacity:0.6"> follows {escape(leader)}</span></td>'
            f'<td style="{NUMBER}">{_position(readings.get(name))}</td></tr>'
            for name, leader in self._leaders.items()
        )
        text = (
            '<table style="font-size:0.75rem;margin:0.5em 0.75em;width:calc(100% - 1.5em);'
            f'overflow-wrap:anywhere;font-variant-numeric:tabular-nums">{rows}</table>'
        )
        if text != self._shown:
            self._shown = text
            self._table.content = text


def _position(reading: JointReading | None) -> str:
    if reading is None or not math.isfinite(reading.position):
        return ""
    # Adding 0.0 makes 0.0 of -0.0.
    return f"{round(reading.position, 3) + 0.0:.3f}"
