"""What of a COLLADA file must be known before trimesh reads it: its unit, and how much it draws."""

from collections.abc import Iterator, Mapping
from pathlib import Path

import lxml.etree as etree
import numpy as np

from arm_description.errors import MeshFileError

MOST_INSTANCES = 10_000
"""Geometries in the scene, each as often as its nodes are used: they take half a minute."""
LONGEST_TEXT = 10_000_000
"""What libxml2 takes in one element, in bytes, unless it is told to take anything."""
DEEPEST = 100
"""How many nodes may lead to a geometry."""


def read_collada_unit(path: Path) -> float:
    """Return how many metres one unit of a file is, for trimesh ignores what COLLADA says.

    Raises:
        MeshFileError: it is no XML, has a DOCTYPE, a unit that is none, or nodes that use each
            other without bound.
    """
    parser = etree.XMLParser(
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        huge_tree=path.stat().st_size > LONGEST_TEXT,
    )
    try:
        document = etree.parse(str(path), parser)
    except etree.XMLSyntaxError as error:
        raise MeshFileError(f"no XML: {error.msg}") from error
    if document.docinfo.internalDTD is not None:
        raise MeshFileError("it has a DOCTYPE, which is not accepted; remove it")
    root = document.getroot()
    _check_instances(root)
    return _unit(root)


def _unit(root: etree._Element) -> float:
    text = next((unit.get("meter") for unit in root.iterfind("{*}asset/{*}unit")), None)
    try:
        unit = 1.0 if text is None else float(text)
    except ValueError as error:
        raise MeshFileError(f"its <unit> is no number: {error}") from error
    if not (np.isfinite(unit) and unit > 0):
        raise MeshFileError(f"its <unit> of {unit:g} m is not above 0")
    return unit


def _check_instances(root: etree._Element) -> None:
    """Refuse few nodes that use each other so often that nobody could draw it."""
    nodes = {f"#{node.get('id')}": node for node in root.iter("{*}node") if node.get("id")}
    counts: dict[str, int] = {}
    total = sum(_instances(scene, nodes, counts, ()) for scene in root.iter("{*}visual_scene"))
    if total > MOST_INSTANCES:
        raise MeshFileError(f"it draws more than {MOST_INSTANCES} geometries")


def _instances(
    element: etree._Element,
    nodes: Mapping[str, etree._Element],
    counts: dict[str, int],
    above: tuple[str, ...],
) -> int:
    """Return how many geometries an element draws; `above` are the nodes that led to it."""
    total = sum(1 for _ in element.iter("{*}instance_geometry", "{*}instance_controller"))
    for url in _used_nodes(element):
        if url in above:
            raise MeshFileError(f"its node '{url}' uses itself")
        if len(above) == DEEPEST:
            raise MeshFileError(f"its nodes use each other more than {DEEPEST} deep")
        if url in nodes and url not in counts:
            counts[url] = _instances(nodes[url], nodes, counts, (*above, url))
        total += counts.get(url, 0)
    # Bounded, for there are numbers of many pages.
    return min(total, MOST_INSTANCES + 1)


def _used_nodes(element: etree._Element) -> Iterator[str]:
    return (used.get("url", "") for used in element.iter("{*}instance_node"))
