"""Graphs in graphviz' language."""

import shutil
import subprocess
from pathlib import Path

from arm_viewer.drawing.digraph import Digraph


def to_dot(graph: Digraph, downward: bool = False) -> str:
    """Return the graph in DOT.

    Args:
        graph: to be written.
        downward: whether arrows go down instead of to the right.
    """
    lines = ["digraph G {", f"  rankdir={'TB' if downward else 'LR'};"]
    for vertex in graph.vertices:
        attributes = f"label={_quoted(vertex.label)}, shape={vertex.shape.value}"
        lines.append(f"  {_quoted(vertex.key)} [{attributes}];")
    for edge in graph.edges:
        label = f" [label={_quoted(edge.label)}]" if edge.label else ""
        lines.append(f"  {_quoted(edge.source)} -> {_quoted(edge.target)}{label};")
    return "\n".join([*lines, "}", ""])


def has_graphviz() -> bool:
    """Return whether graphviz is installed."""
    return shutil.which("dot") is not None


def render_pdf(dot_file: Path, pdf_file: Path) -> bool:
    """Let graphviz make a PDF; return whether it did."""
    command = ["dot", "-Tpdf", str(dot_file), "-o", str(pdf_file)]
    return subprocess.run(command, capture_output=True, check=False).returncode == 0


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'
