"""The curve of a training, as a table and as a picture."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

WIDTH, HEIGHT = 640, 320
LEFT, RIGHT, TOP, BOTTOM = 60, 70, 20, 45
COST_COLOUR, REACHED_COLOUR = "#c2410c", "#1d4ed8"
STYLE = 'font-family="sans-serif" font-size="13" fill="#777"'


@dataclass(frozen=True)
class Generation:
    """The results of one generation.

    Attributes:
        time_s: time since the start.
        cost: median cost of its candidates.
        reached: fraction of the goals that its candidates reach.
    """

    time_s: float
    cost: float
    reached: float

    def __str__(self) -> str:
        return f"{self.time_s:.0f} s, cost {self.cost:.3f}, reached {self.reached:.0%}"


def write(curve: Sequence[Generation], path: Path) -> None:
    """Write a curve as a table."""
    rows = (f"{one.time_s:.1f},{one.cost:.4f},{one.reached:.4f}\n" for one in curve)
    path.write_text("time_s,cost,reached\n" + "".join(rows))


def draw(curve: Sequence[Generation], path: Path) -> None:
    """Draw cost and fraction of reached goals over the generations, as SVG."""
    most = max(one.cost for one in curve)
    costs = _line([one.cost / most for one in curve], COST_COLOUR)
    reached = _line([one.reached for one in curve], REACHED_COLOUR)
    right, bottom = WIDTH - RIGHT, HEIGHT - BOTTOM
    path.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" {STYLE}>\n'
        f'<rect x="{LEFT}" y="{TOP}" width="{right - LEFT}" height="{bottom - TOP}" '
        'fill="none" stroke="#999"/>\n'
        f"{costs}\n{reached}\n"
        f'<text x="{LEFT - 8}" y="{TOP + 5}" text-anchor="end" fill="{COST_COLOUR}">'
        f"{most:.2f}</text>\n"
        f'<text x="{LEFT - 8}" y="{bottom}" text-anchor="end" fill="{COST_COLOUR}">0</text>\n'
        f'<text x="{right + 8}" y="{TOP + 5}" fill="{REACHED_COLOUR}">100 %</text>\n'
        f'<text x="{right + 8}" y="{bottom}" fill="{REACHED_COLOUR}">0 %</text>\n'
        f'<text x="{LEFT}" y="{HEIGHT - 12}" fill="{COST_COLOUR}">median cost</text>\n'
        f'<text x="{LEFT + 100}" y="{HEIGHT - 12}" fill="{REACHED_COLOUR}">goals reached by '
        "all candidates</text>\n"
        f'<text x="{right}" y="{HEIGHT - 12}" text-anchor="end">{len(curve)} generations, '
        f"{curve[-1].time_s:.0f} s</text>\n</svg>\n"
    )


def _line(shares: Sequence[float], colour: str) -> str:
    right, bottom = WIDTH - RIGHT, HEIGHT - BOTTOM
    step = (right - LEFT) / max(1, len(shares) - 1)
    points = " ".join(
        f"{LEFT + index * step:.1f},{bottom - share * (bottom - TOP):.1f}"
        for index, share in enumerate(shares)
    )
    return f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>'
