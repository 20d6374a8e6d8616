"""Writes graphs as DOT, Mermaid, PDF and SVG files."""

import shutil
import subprocess
from pathlib import Path

from arm_cli.output import write_text
from arm_node.drawing import Digraph, Shape, to_svg


def to_dot(graph: Digraph, downward: bool = False) -> str:
    """Return the graph in DOT; arrows point to the right, or downward."""
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
    """Draw a PDF with graphviz; return whether that worked."""
    command = ["dot", "-Tpdf", str(dot_file), "-o", str(pdf_file)]
    return subprocess.run(command, capture_output=True, check=False).returncode == 0


def _quoted(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{escaped}"'


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


def write_picture(graph: Digraph, stem: Path, downward: bool = False) -> Path:
    """Write STEM.gv, and STEM.pdf or STEM.svg; return the picture's path.

    Raises:
        CommandUsageError: the folder cannot be written to.
    """
    dot_file = stem.with_name(f"{stem.name}.gv")
    write_text(dot_file, to_dot(graph, downward))
    pdf_file = stem.with_name(f"{stem.name}.pdf")
    if has_graphviz() and render_pdf(dot_file, pdf_file):
        return pdf_file
    svg_file = stem.with_name(f"{stem.name}.svg")
    write_text(svg_file, to_svg(graph, downward))
    return svg_file
