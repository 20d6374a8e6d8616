"""Graphs as SVG pictures."""

from dataclasses import dataclass
from html import escape
from itertools import pairwise

from arm_cli.drawing.digraph import Digraph, Shape, Vertex
from arm_cli.drawing.layered_layout import Layout, place

CHARACTER_WIDTH = 7.2
LINE_HEIGHT = 16.0
PADDING = 14.0
ROW_GAP = 18.0
LAYER_GAP = 60.0
MARGIN = 20.0
BEND_HEIGHT = 10.0

HEAD = 8.0

_FILLS = {
    Shape.ELLIPSE: 'fill="#dbeafe" stroke="#2563eb"',
    Shape.BOX: 'fill="#f1f5f9" stroke="#64748b"',
}
_TEXT = "#1f2933"
_LABEL = "#475569"


@dataclass(frozen=True, slots=True)
class _Spot:
    """Centre and size of a vertex or a bend, in pixels."""

    x: float
    y: float
    width: float
    height: float


def to_svg(graph: Digraph) -> str:
    """Return a picture of the graph: ellipses in blue, boxes in grey."""
    layout = place(graph)
    vertices = {vertex.key: vertex for vertex in graph.vertices}
    gap = LAYER_GAP + max((_text_size(edge.label)[0] for edge in graph.edges), default=0.0)
    spots, width, height = _spots(layout, vertices, gap)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" '
        f'viewBox="0 0 {width:.0f} {height:.0f}">',
        f'<rect width="{width:.0f}" height="{height:.0f}" fill="#ffffff"/>',
        '<g font-family="monospace" font-size="12" text-anchor="middle">',
    ]
    for edge, route in zip(graph.edges, layout.routes, strict=True):
        parts += _arrow([spots[key] for key in route], edge.label)
    parts += [_shape(vertex, spots[vertex.key]) for vertex in graph.vertices]
    return "\n".join([*parts, "</g>", "</svg>", ""])


def _spots(
    layout: Layout, vertices: dict[str, Vertex], gap: float
) -> tuple[dict[str, _Spot], float, float]:
    sizes = {key: _size(vertices.get(key)) for layer in layout.layers for key in layer}
    heights = [sum(sizes[key][1] + ROW_GAP for key in layer) for layer in layout.layers]
    total_height = max(heights, default=0.0)
    spots: dict[str, _Spot] = {}
    left = MARGIN
    for layer, layer_height in zip(layout.layers, heights, strict=True):
        layer_width = max((sizes[key][0] for key in layer), default=0.0)
        top = MARGIN + (total_height - layer_height) / 2
        for key in layer:
            width, height = sizes[key]
            spots[key] = _Spot(left + layer_width / 2, top + height / 2, width, height)
            top += height + ROW_GAP
        left += layer_width + gap
    return spots, left - gap + MARGIN, total_height + 2 * MARGIN


def _size(vertex: Vertex | None) -> tuple[float, float]:
    if vertex is None:
        return 0.0, BEND_HEIGHT
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


def _text(text: str, x: float, y: float, fill: str) -> str:
    lines = text.split("\n")
    top = y - (len(lines) - 1) * LINE_HEIGHT / 2
    return "".join(
        f'<text x="{x:.1f}" y="{top + index * LINE_HEIGHT:.1f}" dy="4" fill="{fill}">'
        f"{escape(line)}</text>"
        for index, line in enumerate(lines)
    )


def _arrow(spots: list[_Spot], label: str) -> list[str]:
    sign = 1 if spots[-1].x >= spots[0].x else -1
    points = [
        (spots[0].x + sign * spots[0].width / 2, spots[0].y),
        *((spot.x, spot.y) for spot in spots[1:-1]),
        (spots[-1].x - sign * spots[-1].width / 2, spots[-1].y),
    ]
    path = f"M{points[0][0]:.1f} {points[0][1]:.1f}"
    for (x0, y0), (x1, y1) in pairwise(points):
        middle = (x0 + x1) / 2
        path += f"C{middle:.1f} {y0:.1f} {middle:.1f} {y1:.1f} {x1:.1f} {y1:.1f}"
    tip_x, tip_y = points[-1]
    back = tip_x - sign * HEAD
    head = f"M{tip_x:.1f} {tip_y:.1f}L{back:.1f} {tip_y - 4:.1f}V{tip_y + 4:.1f}z"
    parts = [
        f'<path fill="none" stroke="{_LABEL}" d="{path}"/>',
        f'<path fill="{_LABEL}" d="{head}"/>',
    ]
    if label:
        (x0, y0), (x1, y1) = points[0], points[1]
        parts.append(_text(label, (x0 + x1) / 2, (y0 + y1) / 2, _LABEL))
    return parts
