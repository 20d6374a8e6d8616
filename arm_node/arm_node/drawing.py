"""Draws graphs as SVG: vertices, edges, a layered layout; and the graph of nodes and topics.

The layout is the method of Sugiyama, Tagawa and Toda (1981): arrows that close a cycle are
temporarily reversed; each vertex is placed one layer behind the last vertex that points to it; long
arrows get a bend in each layer between; a few sweeps order every layer by the mean position of its
neighbours.
"""

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum
from html import escape
from itertools import pairwise


class Shape(Enum):
    """Outline of a vertex."""

    ELLIPSE = "ellipse"
    BOX = "box"


@dataclass(frozen=True, slots=True)
class Vertex:
    """One vertex; its label may have several lines."""

    key: str
    label: str
    shape: Shape = Shape.ELLIPSE


@dataclass(frozen=True, slots=True)
class Edge:
    """An arrow between two vertices, by their keys; its label may have several lines."""

    source: str
    target: str
    label: str = ""


@dataclass(frozen=True, slots=True)
class Digraph:
    """Vertices and the arrows between them."""

    vertices: tuple[Vertex, ...]
    edges: tuple[Edge, ...]


SWEEPS = 4


@dataclass(frozen=True, slots=True)
class Layout:
    """Layers of vertices, and the route of each arrow.

    Attributes:
        layers: keys of vertices and bends, layer by layer, each from top to bottom.
        routes: for each edge of the graph, the keys along it, from source to target.
    """

    layers: tuple[tuple[str, ...], ...]
    routes: tuple[tuple[str, ...], ...]


def place(graph: Digraph) -> Layout:
    """Return the layout of a graph."""
    arrows = [(edge.source, edge.target) for edge in graph.edges]
    keys = [vertex.key for vertex in graph.vertices]
    forward = _without_cycles(keys, arrows)
    depth = _depths(keys, forward)
    layers: list[list[str]] = [[] for _ in range(max(depth.values(), default=0) + 1)]
    for key in keys:
        layers[depth[key]].append(key)
    routes = []
    for index, (arrow, (source, target)) in enumerate(zip(arrows, forward, strict=True)):
        bends = [f"bend {index} {level}" for level in range(depth[source] + 1, depth[target])]
        for level, bend in enumerate(bends, start=depth[source] + 1):
            layers[level].append(bend)
        route = (source, *bends, target)
        routes.append(route if arrow == (source, target) else route[::-1])
    _order(layers, routes)
    return Layout(tuple(tuple(layer) for layer in layers), tuple(routes))


def _without_cycles(keys: list[str], arrows: list[tuple[str, str]]) -> list[tuple[str, str]]:
    """Return the arrows, with those reversed that would close a cycle."""
    targets: dict[str, list[str]] = defaultdict(list)
    for source, target in arrows:
        targets[source].append(target)
    finished: dict[str, int] = {}
    for root in keys:
        stack = [(root, iter(targets[root]))] if root not in finished else []
        open_: set[str] = {root}
        while stack:
            key, rest = stack[-1]
            following = next((t for t in rest if t not in finished and t not in open_), None)
            if following is None:
                stack.pop()
                finished[key] = len(finished)
            else:
                open_.add(following)
                stack.append((following, iter(targets[following])))
    # An arrow to a vertex that is finished later leads up the search tree and closes a cycle.
    return [(t, s) if finished[t] > finished[s] else (s, t) for s, t in arrows]


def _depths(keys: list[str], arrows: list[tuple[str, str]]) -> dict[str, int]:
    """Return the layer of each vertex: the number of arrows on the longest path to it."""
    depth = dict.fromkeys(keys, 0)
    for _ in keys:
        changed = False
        for source, target in arrows:
            if source != target and depth[target] <= depth[source]:
                depth[target] = depth[source] + 1
                changed = True
        if not changed:
            break
    return depth


def _order(layers: list[list[str]], routes: list[tuple[str, ...]]) -> None:
    """Sort every layer by the mean position of its neighbours, from the left and the right."""
    before: dict[str, list[str]] = defaultdict(list)
    behind: dict[str, list[str]] = defaultdict(list)
    level = {key: index for index, layer in enumerate(layers) for key in layer}
    for first, second in (step for route in routes for step in pairwise(route)):
        if first == second:
            continue
        left, right = sorted((first, second), key=level.__getitem__)
        behind[left].append(right)
        before[right].append(left)
    for _ in range(SWEEPS):
        for layer, beside in pairwise(layers):
            _sort_by_neighbours(beside, layer, before)
        for beside, layer in pairwise(reversed(layers)):
            _sort_by_neighbours(layer, beside, behind)


def _sort_by_neighbours(
    layer: list[str], beside: list[str], neighbours: dict[str, list[str]]
) -> None:
    place_of = {key: place for place, key in enumerate(beside)}
    current = {key: place for place, key in enumerate(layer)}

    def mean_place(key: str) -> float:
        places = [place_of[neighbour] for neighbour in neighbours[key]]
        return sum(places) / len(places) if places else float(current[key])

    layer.sort(key=mean_place)


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

    Arrows point right, or down if `downward`.
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


UBIQUITOUS = ("/rosout", "/parameter_events")
"""Topics of nearly every node, which would clutter the picture."""


@dataclass(frozen=True, slots=True)
class NodeTopics:
    """A node and its topics, by their absolute names."""

    name: str
    publishes: tuple[str, ...]
    subscribes: tuple[str, ...]


def node_graph(nodes: Iterable[NodeTopics], complete: bool = False) -> Digraph:
    """Return nodes as ellipses, topics as boxes, and arrows in the direction of the messages.

    `complete` also draws hidden nodes and topics, /rosout and /parameter_events.
    """

    def shown(names: Iterable[str]) -> list[str]:
        return [name for name in names if complete or not _is_left_out(name)]

    vertices: dict[str, Vertex] = {}
    edges: list[Edge] = []
    for node in nodes:
        if shown([node.name]):
            key = f"node {node.name}"
            vertices[key] = Vertex(key, node.name)
            edges += [Edge(key, f"topic {topic}") for topic in shown(node.publishes)]
            edges += [Edge(f"topic {topic}", key) for topic in shown(node.subscribes)]
    for topic in sorted({key for e in edges for key in (e.source, e.target)} - vertices.keys()):
        vertices[topic] = Vertex(topic, topic.removeprefix("topic "), Shape.BOX)
    return Digraph(tuple(vertices.values()), tuple(edges))


def _is_left_out(name: str) -> bool:
    # As usual in ROS, a name with a part that begins with an underscore is hidden.
    return name in UBIQUITOUS or "/_" in name
