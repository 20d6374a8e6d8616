"""Graphs in Mermaid, which GitHub and many editors draw."""

from arm_viewer.drawing.digraph import Digraph, Shape


def to_mermaid(graph: Digraph) -> str:
    """Return the graph as a Mermaid flow chart."""
    identifiers = {vertex.key: f"v{index}" for index, vertex in enumerate(graph.vertices)}
    lines = ["flowchart LR"]
    for vertex in graph.vertices:
        left, right = ("([", "])") if vertex.shape is Shape.ELLIPSE else ("[", "]")
        lines.append(f'  {identifiers[vertex.key]}{left}"{_escaped(vertex.label)}"{right}')
    for edge in graph.edges:
        label = f'|"{_escaped(edge.label)}"|' if edge.label else ""
        lines.append(f"  {identifiers[edge.source]} -->{label} {identifiers[edge.target]}")
    return "\n".join([*lines, ""])


def _escaped(text: str) -> str:
    return text.replace('"', "#quot;").replace("\n", "<br>")
