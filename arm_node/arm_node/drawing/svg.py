"""Draws graphs as SVG."""

from dataclasses import dataclass
from html import escape
from itertools import pairwise

from arm_node.drawing.digraph import Digraph, Shape, Vertex
from arm_node.drawing.layered_layout import Layout, place

CHARACTER_WIDTH = 7.2
LINE_HEIGHT = 16.0
PADDING = 14.0
ROW_GAP = 18.0
LAYER_GAP = 60.0
MARGIN = 20.0

HEAD = 8.0

_BEND = (10.0, 10.0)
_NOTHING = (0.0, 0.0)

_FILLS = {
    Shape.ELLIPSE: 'fill="#dbeafe" stroke="#2563eb"',
    Shape.BOX: 'fill="#f1f5f9" stroke="#64748b"',
}
_LINE = "#475569"
_TEXT = 'fill="#1f2933"'
_LABEL = f'fill="{_LINE}" stroke="#ffffff" stroke-width="3" paint-order="stroke"'


@dataclass(frozen=True, slots=True)
class _Spot:
    """Centre and size of a vertex or a bend, in pixels."""

    x: float
    y: float
    width: float
    height: float


def to_svg(graph: Digraph, downward: bool = False) -> str:
    """Return a picture of the graph: ellipses in blue, boxes in grey.

    Args:
        graph: the graph.
        downward: whether arrows point down instead of right.
    """
    layout = place(graph)
    spots, width, height = _spots(graph, layout, downward)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" '
        f'viewBox="0 0 {width:.0f} {height:.0f}">',
        f'<rect width="{width:.0f}" height="{height:.0f}" fill="#ffffff"/>',
        '<g font-family="monospace" font-size="12" text-anchor="middle">',
    ]
    for edge, route in zip(graph.edges, layout.routes, strict=True):
        parts += _arrow([spots[key] for key in route], edge.label, downward)
    parts += [_shape(vertex, spots[vertex.key]) for vertex in graph.vertices]
    return "\n".join([*parts, "</g>", "</svg>", ""])


def _spots(graph: Digraph, layout: Layout, downward: bool) -> tuple[dict[str, _Spot], float, float]:
    """Return the position of each vertex and bend, and the picture's width and height.

    Layers follow each other along the arrows; across them, each vertex gets enough room for the
    labels of its incoming arrows.
    """
    along, across = (1, 0) if downward else (0, 1)
    sizes = {vertex.key: _size(vertex) for vertex in graph.vertices}
    labels = {edge.target: _text_size(edge.label) for edge in graph.edges if edge.label}
    gap = LAYER_GAP + max((label[along] for label in labels.values()), default=0.0)
    rows = [
        [
            (key, size, max(size[across], labels.get(key, _NOTHING)[across]) + ROW_GAP)
            for key in layer
            for size in (sizes.get(key, _BEND),)
        ]
        for layer in layout.layers
    ]
    breadth = max((sum(room for _, _, room in row) for row in rows), default=0.0)
    spots: dict[str, _Spot] = {}
    start = MARGIN
    for row in rows:
        depth = max((size[along] for _, size, _ in row), default=0.0)
        side = MARGIN + (breadth - sum(room for _, _, room in row)) / 2
        for key, size, room in row:
            centre = (start + depth / 2, side + room / 2)
            spots[key] = _Spot(centre[along], centre[across], *size)
            side += room
        start += depth + gap
    extent = (start - gap + MARGIN, breadth + 2 * MARGIN)
    return spots, extent[along], extent[across]


def _size(vertex: Vertex) -> tuple[float, float]:
    width, height = _text_size(vertex.label)
    return width + 2 * PADDING, height + PADDING


def _text_size(text: str) -> tuple[float, float]:
    lines = text.split("\n")
    return max(len(line) for line in lines) * CHARACTER_WIDTH, len(lines) * LINE_HEIGHT


def _shape(vertex: Vertex, spot: _Spot) -> str:
    radius = spot.height / 2 if vertex.shape is Shape.ELLIPSE else 3
    outline = (
        f'<rect {_FILLS[vertex.shape]} x="{spot.x - spot.width / 2:.1f}" '
        f'y="{spot.y - spot.height / 2:.1f}" width="{spot.width:.1f}" '
        f'height="{spot.height:.1f}" rx="{radius:.1f}"/>'
    )
    return outline + _text(vertex.label, spot.x, spot.y, _TEXT)


def _text(text: str, x: float, y: float, style: str) -> str:
    lines = text.split("\n")
    top = y - (len(lines) - 1) * LINE_HEIGHT / 2
    return "".join(
        f'<text x="{x:.1f}" y="{top + index * LINE_HEIGHT:.1f}" dy="4" {style}>'
        f"{escape(line)}</text>"
        for index, line in enumerate(lines)
    )


def _arrow(spots: list[_Spot], label: str, downward: bool) -> list[str]:
    first, last = spots[0], spots[-1]
    forward = last.y >= first.y if downward else last.x >= first.x
    sign = 1 if forward else -1
    points = [
        _border(first, sign, downward),
        *((spot.x, spot.y) for spot in spots[1:-1]),
        _border(last, -sign, downward),
    ]
    path = f"M{points[0][0]:.1f} {points[0][1]:.1f}"
    for (x0, y0), (x1, y1) in pairwise(points):
        bends = (x0, (y0 + y1) / 2, x1, (y0 + y1) / 2)
        if not downward:
            bends = ((x0 + x1) / 2, y0, (x0 + x1) / 2, y1)
        path += "C" + " ".join(f"{number:.1f}" for number in (*bends, x1, y1))
    parts = [
        f'<path fill="none" stroke="{_LINE}" d="{path}"/>',
        f'<path fill="{_LINE}" d="{_head(points[-1], sign, downward)}"/>',
    ]
    if label:
        (x0, y0), (x1, y1) = points[-2:]
        middle = (x1, (y0 + y1) / 2) if downward else ((x0 + x1) / 2, y1)
        parts.append(_text(label, *middle, _LABEL))
    return parts


def _border(spot: _Spot, sign: int, downward: bool) -> tuple[float, float]:
    if downward:
        return spot.x, spot.y + sign * spot.height / 2
    return spot.x + sign * spot.width / 2, spot.y


def _head(tip: tuple[float, float], sign: int, downward: bool) -> str:
    x, y = tip
    if downward:
        back = y - sign * HEAD
        return f"M{x:.1f} {y:.1f}L{x - 4:.1f} {back:.1f}H{x + 4:.1f}z"
    back = x - sign * HEAD
    return f"M{x:.1f} {y:.1f}L{back:.1f} {y - 4:.1f}V{y + 4:.1f}z"
