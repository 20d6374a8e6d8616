"""The curve of a training, as a table and as a picture."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

WIDTH, HEIGHT = 640, 320
LEFT, RIGHT, TOP, BOTTOM = 60, 70, 20, 45
ERROR_COLOUR, LIFTED_COLOUR = "#c2410c", "#1d4ed8"
STYLE = 'font-family="sans-serif" font-size="13" fill="#777"'


@dataclass(frozen=True)
class Epoch:
    """What a policy was after an epoch of its training.

    Attributes:
        number: the epoch, from 1.
        error: mean square of the errors of its commands, in units of their spread.
        lifted: fraction of new picks in which it lifts the cylinder.
    """

    number: int
    error: float
    lifted: float

    def __str__(self) -> str:
        return f"epoch {self.number}: error {self.error:.4f}, lifted {self.lifted:.0%}"


def write(curve: Sequence[Epoch], path: Path) -> None:
    """Write a curve as a table."""
    rows = (f"{one.number},{one.error:.5f},{one.lifted:.2f}\n" for one in curve)
    path.write_text("epoch,error,lifted\n" + "".join(rows))


def draw(curve: Sequence[Epoch], path: Path) -> None:
    """Draw errors and lifted shares over the epochs, as SVG."""
    right, bottom = WIDTH - RIGHT, HEIGHT - BOTTOM
    most = max(one.error for one in curve)

    def line(shares: list[float], colour: str) -> str:
        points = " ".join(
            f"{LEFT + one.number / curve[-1].number * (right - LEFT):.1f},"
            f"{bottom - share * (bottom - TOP):.1f}"
            for one, share in zip(curve, shares, strict=True)
        )
        return f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>'

    def words(x: int, y: int, said: str, colour: str = "#777", anchor: str = "start") -> str:
        return f'<text x="{x}" y="{y}" text-anchor="{anchor}" fill="{colour}">{said}</text>'

    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" {STYLE}>',
        f'<rect x="{LEFT}" y="{TOP}" width="{right - LEFT}" height="{bottom - TOP}" '
        'fill="none" stroke="#999"/>',
        line([one.error / most for one in curve], ERROR_COLOUR),
        line([one.lifted for one in curve], LIFTED_COLOUR),
        words(LEFT - 8, TOP + 5, f"{most:.3f}", ERROR_COLOUR, "end"),
        words(LEFT - 8, bottom, "0", ERROR_COLOUR, "end"),
        words(right + 8, TOP + 5, "100 %", LIFTED_COLOUR),
        words(right + 8, bottom, "0 %", LIFTED_COLOUR),
        words(LEFT, HEIGHT - 12, "squared error", ERROR_COLOUR),
        words(LEFT + 100, HEIGHT - 12, "new picks that lift the cylinder", LIFTED_COLOUR),
        words(right, HEIGHT - 12, f"{curve[-1].number} epochs", anchor="end"),
        "</svg>\n",
    ]
    path.write_text("\n".join(parts))
