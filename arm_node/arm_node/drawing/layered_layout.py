"""Places the vertices of a graph in layers, from left to right.

The method of Sugiyama, Tagawa and Toda (1981): arrows that close a cycle are temporarily reversed;
each vertex is placed one layer behind the last vertex that points to it; long arrows get a bend in
each layer between; a few sweeps order every layer by the mean position of its neighbours.
"""

from collections import defaultdict
from dataclasses import dataclass
from itertools import pairwise

from arm_node.drawing.digraph import Digraph

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
