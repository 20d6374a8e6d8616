"""Simulation time, real-time factor and lag."""

import math

from viser import GuiApi

from arm_viewer.snapshot import SimulationTime, Snapshot

PERIOD_S = 0.5
NO_CLOCK = "no /clock: wall time is used"


class ClockPanel:
    """Shows simulation time, real-time factor and lag."""

    def __init__(self) -> None:
        self._drawn_s = -math.inf
        self._shown = ""

    def build(self, gui: GuiApi) -> None:
        """Create the text."""
        with gui.add_folder("Time"):
            self._text = gui.add_html("")

    def update(self, snapshot: Snapshot) -> None:
        """Show the numbers twice a second."""
        if snapshot.made_s - self._drawn_s < PERIOD_S:
            return
        self._drawn_s = snapshot.made_s
        text = _html(snapshot.time)
        if text != self._shown:
            self._shown = text
            self._text.content = text


def _html(time: SimulationTime | None) -> str:
    rows = {"Simulation": NO_CLOCK} if time is None else _numbers(time)
    lines = "".join(
        f'<tr><td style="opacity:0.65;padding-right:1em">{name}</td><td>{value}</td></tr>'
        for name, value in rows.items()
    )
    return (
        '<table style="font-size:0.8rem;margin:0.25em 0.75em;font-variant-numeric:tabular-nums">'
        f"{lines}</table>"
    )


def _numbers(time: SimulationTime) -> dict[str, str]:
    state = "paused" if time.factor == 0.0 else f"{time.factor:.2f}"
    return {
        "Simulation": f"{time.time_s:.1f} s",
        "Real-time factor": state,
        "Lag": f"{time.lag_s:.2f} s in the last {time.measured_s:.0f} s",
    }
