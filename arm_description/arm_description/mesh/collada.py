"""Checks a COLLADA file before trimesh reads it: its unit, and how much it draws."""

import io
from collections.abc import Mapping
from pathlib import Path

import lxml.etree as etree
import numpy as np

from arm_description.errors import MeshFileError
from arm_description.mesh.collada_forms import rewrite
from arm_description.mesh.data import LARGEST_BYTES
from arm_description.mesh.scene_graph import SceneNode, check_scene
from arm_node.user_file import read_bytes

MAX_TEXT = 10_000_000
"""Bytes that libxml2 accepts in one element, unless told to accept any size."""


def read_collada(path: Path) -> tuple[bytes, float]:
    """Return the content of a file as trimesh reads it rightly, and the length of its unit in m.

    trimesh ignores COLLADA's <unit>.

    Raises:
        MeshFileError: the file is not XML, or has a DOCTYPE, an invalid unit, broken numbers, or
            nodes that use each other without bound.
    """
    parser = etree.XMLParser(
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        huge_tree=path.stat().st_size > MAX_TEXT,
    )
    try:
        content = read_bytes(path, LARGEST_BYTES)
        document = etree.parse(io.BytesIO(content), parser)
    except etree.XMLSyntaxError as error:
        raise MeshFileError(f"it is not XML: {error.msg}") from error
    if document.docinfo.internalDTD is not None:
        raise MeshFileError("it has a DOCTYPE, which is not accepted; remove it")
    root = document.getroot()
    _check_instances(root)
    unit = _unit(root)
    return (etree.tostring(root) if rewrite(root) else content), unit


def _unit(root: etree._Element) -> float:
    text = next((unit.get("meter") for unit in root.iterfind("{*}asset/{*}unit")), None)
    try:
        unit = 1.0 if text is None else float(text)
    except ValueError as error:
        raise MeshFileError(f"its <unit> is not a number: {error}") from error
    if not (np.isfinite(unit) and unit > 0):
        raise MeshFileError(f"its <unit> of {unit:g} m is not above 0")
    return unit


def _check_instances(root: etree._Element) -> None:
    nodes = {f"#{node.get('id')}": node for node in root.iter("{*}node") if node.get("id")}
    corners = {f"#{g.get('id')}": _corners(g) for g in root.iter("{*}geometry")}
    scenes = {f"scene {n}": scene for n, scene in enumerate(root.iter("{*}visual_scene"))}

    def find(name: str) -> SceneNode | None:
        element = scenes[name] if name in scenes else nodes.get(name)
        return None if element is None else _scene_node(element, corners)

    check_scene(scenes, find)


def _scene_node(element: etree._Element, corners: Mapping[str, int]) -> SceneNode:
    """Return what an element and the elements within it use."""
    drawn = list(element.iter("{*}instance_geometry", "{*}instance_controller"))
    return SceneNode(
        len(drawn),
        tuple(used.get("url", "") for used in element.iter("{*}instance_node")),
        sum(corners.get(geometry.get("url", ""), 0) for geometry in drawn),
    )


def _corners(geometry: etree._Element) -> int:
    """Estimate how many corners a geometry's faces have: one digit and one blank each."""
    return sum(len(indices.text or "") for indices in geometry.iter("{*}p")) // 2
