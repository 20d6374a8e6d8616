"""What of a COLLADA file must be known before trimesh reads it: its unit, and how much it draws."""

from pathlib import Path

import lxml.etree as etree
import numpy as np

from arm_description.errors import MeshFileError
from arm_description.scene_graph import SceneNode, check_scene

LONGEST_TEXT = 10_000_000
"""What libxml2 takes in one element, in bytes, unless it is told to take anything."""


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
    nodes = {f"#{node.get('id')}": node for node in root.iter("{*}node") if node.get("id")}
    scenes = {f"scene {n}": scene for n, scene in enumerate(root.iter("{*}visual_scene"))}

    def find(name: str) -> SceneNode | None:
        element = scenes[name] if name in scenes else nodes.get(name)
        return None if element is None else _scene_node(element)

    check_scene(scenes, find)


def _scene_node(element: etree._Element) -> SceneNode:
    """Return what an element uses, elements within it included."""
    return SceneNode(
        sum(1 for _ in element.iter("{*}instance_geometry", "{*}instance_controller")),
        tuple(used.get("url", "") for used in element.iter("{*}instance_node")),
    )
