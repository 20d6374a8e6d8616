"""Measures of meshes: of what was read from a file, and of a robot's links."""

import numpy as np
import trimesh

from arm_description import Mesh, Robot, resolve_uri


def measures(parts) -> tuple[float, float, list, list]:
    """The area, the volume and the bounds of all parts."""
    area = volume = 0.0
    for part in parts:
        a, b, c = np.moveaxis(part.vertices[part.faces], 1, 0)
        area += np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
        volume += np.einsum("fk,fk->f", a, np.cross(b, c)).sum() / 6
    every = np.concatenate([part.vertices for part in parts])
    return area, volume, every.min(axis=0).tolist(), every.max(axis=0).tolist()


def visuals(robot: Robot, link: str) -> list[trimesh.Trimesh]:
    """The meshes that a link shows."""
    geometries = [visual.geometry for visual in robot.link(link).visuals]
    return [trimesh.load_mesh(resolve_uri(g.uri)) for g in geometries if isinstance(g, Mesh)]


def bounds(robot: Robot, link: str) -> np.ndarray:
    """The bounding box of what a link shows, in its frame, in m, (2, 3)."""
    boxes = np.array([mesh.bounds for mesh in visuals(robot, link)])
    return np.array([boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)])
