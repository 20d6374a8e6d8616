"""A directed graph for drawing."""

from dataclasses import dataclass
from enum import Enum


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
