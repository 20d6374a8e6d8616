"""A graph into a file: PDF where graphviz is installed, SVG by this package itself elsewhere."""

from pathlib import Path

from arm_cli.drawing.dot import has_graphviz, render_pdf, to_dot
from arm_cli.errors import UsageError
from arm_viewer.drawing.digraph import Digraph
from arm_viewer.drawing.svg import to_svg


def write_picture(graph: Digraph, stem: Path, downward: bool = False) -> Path:
    """Write STEM.gv, and STEM.pdf or STEM.svg; return the picture's path.

    Args:
        graph: to be drawn.
        stem: path without suffix.
        downward: whether arrows go down instead of to the right.

    Raises:
        UsageError: the folder cannot be written to.
    """
    dot_file = stem.with_name(f"{stem.name}.gv")
    write_text(dot_file, to_dot(graph, downward))
    pdf_file = stem.with_name(f"{stem.name}.pdf")
    if has_graphviz() and render_pdf(dot_file, pdf_file):
        return pdf_file
    svg_file = stem.with_name(f"{stem.name}.svg")
    write_text(svg_file, to_svg(graph, downward))
    return svg_file


def write_text(path: Path, text: str) -> None:
    """Write a file.

    Raises:
        UsageError: it cannot be written.
    """
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror}") from error
