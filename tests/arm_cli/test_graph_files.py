"""Graphs: Mermaid, DOT, and the choice between PDF and SVG."""

from xml.etree import ElementTree

import pytest

from arm_cli import graph_files
from arm_cli.errors import CommandUsageError
from arm_cli.graph_files import to_dot, to_mermaid
from arm_node.drawing import Digraph, Edge, Shape, Vertex


def graph_of(*pairs, label=""):
    keys = dict.fromkeys(key for pair in pairs for key in pair)
    vertices = tuple(Vertex(key, f"/{key}") for key in keys)
    return Digraph(vertices, tuple(Edge(a, b, label) for a, b in pairs))


def test_mermaid():
    graph = Digraph((Vertex("a", 'n"n'), Vertex("b", "/b", Shape.BOX)), (Edge("a", "b"),))
    assert to_mermaid(graph) == ('flowchart LR\n  v0(["n#quot;n"])\n  v1["/b"]\n  v0 --> v1\n')


def test_dot():
    graph = Digraph((Vertex("a", "x\ny"), Vertex("b", "/b", Shape.BOX)), (Edge("a", "b", "l"),))
    assert to_dot(graph).splitlines() == [
        "digraph G {",
        "  rankdir=LR;",
        '  "a" [label="x\\ny", shape=ellipse];',
        '  "b" [label="/b", shape=box];',
        '  "a" -> "b" [label="l"];',
        "}",
    ]


def test_without_graphviz_the_picture_is_svg(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    path = graph_files.write_picture(graph_of("ab"), tmp_path / "frames")
    assert path == tmp_path / "frames.svg"
    assert ElementTree.fromstring(path.read_text()).tag == "{http://www.w3.org/2000/svg}svg"
    assert (tmp_path / "frames.gv").read_text().startswith("digraph")


def test_with_graphviz_the_picture_is_pdf(tmp_path, monkeypatch):
    tool = tmp_path / "dot"
    tool.write_text('#!/bin/sh\necho "$1 $(head -c 9 $2)" > $4\n')
    tool.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    path = graph_files.write_picture(graph_of("ab"), tmp_path / "frames_1.2")
    assert path == tmp_path / "frames_1.2.pdf"
    assert path.read_text() == "-Tpdf digraph G\n"


def test_a_missing_folder_is_reported(tmp_path):
    with pytest.raises(CommandUsageError, match=r"cannot write .*frames.gv: No such file"):
        graph_files.write_picture(graph_of("ab"), tmp_path / "none" / "frames")
