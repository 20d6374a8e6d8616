"""`<inertial auto="true">`: compute mass and inertia of a link from its collisions."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.transforms import transform, wxyz_from_rpy
from arm_description.urdf.robot import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Inertial,
    Link,
    Mesh,
    Pose,
    Sphere,
)
from arm_gazebo.errors import MeshError
from arm_gazebo.mesh.library import MeshLibrary
from arm_node.frozen import frozen

DEFAULT_DENSITY = 1000.0
"""SDF's default in kg/m3, the density of water."""


@frozen
class AutoInertia:
    """The input for the inertia of one link.

    Attributes:
        densities: density of each collision in kg/m3.
        mass: total mass in kg that the result is scaled to; None to use the densities alone.
    """

    densities: tuple[float, ...]
    mass: float | None = None


def auto_inertial(link: Link, auto: AutoInertia, meshes: MeshLibrary) -> Inertial | None:
    """Return the inertia of a link with solid collisions; None if they have no volume.

    A mesh that does not enclose a volume counts as its convex hull. A missing mesh is skipped.
    """
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body()
    try:
        for collision, density in zip(link.collisions, auto.densities, strict=True):
            _add_solid(spec, body, collision, density, meshes)
        model = spec.compile()
    except ValueError:
        # MuJoCo raises this for a flat mesh and for an overflow.
        return None
    mass = float(model.body_mass[1])
    if mass <= 0:
        return None
    scale = 1.0 if auto.mass is None else auto.mass / mass
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, model.body_iquat[1])
    pose = Pose.of(transform(rotation.reshape(3, 3), model.body_ipos[1]))
    ixx, iyy, izz = (model.body_inertia[1] * scale).tolist()
    return Inertial(mass * scale, pose, (ixx, 0.0, 0.0, iyy, 0.0, izz))


def _add_solid(
    spec: mujoco.MjSpec,
    body: mujoco.MjsBody,
    collision: Collision,
    density: float,
    meshes: MeshLibrary,
) -> None:
    kinds = mujoco.mjtGeom
    match collision.geometry:
        case Mesh() as mesh:
            try:
                name = _add_mesh(spec, meshes, mesh)
            except MeshError:
                return
            geom = body.add_geom(type=kinds.mjGEOM_MESH, meshname=name)
        case Box((x, y, z)):
            geom = body.add_geom(type=kinds.mjGEOM_BOX, size=[x / 2, y / 2, z / 2])
        case Sphere(radius):
            geom = body.add_geom(type=kinds.mjGEOM_SPHERE, size=[radius, 0.0, 0.0])
        case Cylinder(radius, length):
            geom = body.add_geom(type=kinds.mjGEOM_CYLINDER, size=[radius, length / 2, 0.0])
        case Capsule(radius, length):
            geom = body.add_geom(type=kinds.mjGEOM_CAPSULE, size=[radius, length / 2, 0.0])
    geom.pos = collision.origin.xyz
    geom.quat = wxyz_from_rpy(collision.origin.rpy)
    geom.density = density


def _add_mesh(spec: mujoco.MjSpec, meshes: MeshLibrary, mesh: Mesh) -> str:
    """Add all parts of a mesh as one, because they may enclose a volume only together."""
    parts = [part.drawn for part in meshes.parts(mesh)]
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    vertices = np.concatenate([part.vertices for part in parts])
    faces = np.concatenate([part.faces + at for part, at in zip(parts, starts, strict=False)])
    kinds = mujoco.mjtMeshInertia
    name = f"mesh_{len(spec.meshes)}"
    spec.add_mesh(
        name=name,
        uservert=vertices.ravel(),
        userface=faces.ravel(),
        inertia=kinds.mjMESH_INERTIA_EXACT
        if _encloses(vertices, faces)
        else kinds.mjMESH_INERTIA_CONVEX,
    )
    return name


def _encloses(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> bool:
    """Return whether triangles enclose a volume and face outwards.

    The vertices have the shape (v, 3), their indices in the triangles (f, 3).
    """
    a, b, c = vertices[faces].transpose(1, 0, 2)
    if np.einsum("ij,ij->", a, np.cross(b, c)) <= 0:
        return False
    _, same = np.unique(vertices, axis=0, return_inverse=True)
    start = same.reshape(-1).astype(np.int64)[faces]
    end = np.roll(start, -1, axis=1)
    # In a closed surface each edge belongs to two triangles, which run along it in opposite ways.
    forward, backward = start * len(vertices) + end, end * len(vertices) + start
    return np.array_equal(np.sort(forward, axis=None), np.sort(backward, axis=None))
