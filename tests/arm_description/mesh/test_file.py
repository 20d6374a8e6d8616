"""Mesh files that trimesh reads: where their parts stand, and their colours."""

import struct
import tracemalloc

import mujoco
import numpy as np
import pytest
import trimesh

from arm_description.errors import MeshFileError
from arm_description.mesh.data import merged
from arm_description.mesh.file import read_mesh_file


def volume(mesh):
    return trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).volume


def test_parts_are_placed_as_in_the_file_and_a_mirrored_one_keeps_its_outside(tmp_path):
    scene = trimesh.Scene()
    scene.add_geometry(trimesh.creation.box([0.1, 0.2, 0.3]), transform=np.diag([-1, 2, 1, 1]))
    moved = trimesh.transformations.compose_matrix(
        translate=[1, 2, 3], angles=[0.0, 0.0, np.pi / 2]
    )
    scene.add_geometry(trimesh.creation.box([0.1, 0.2, 0.3]), transform=moved)
    scene.export(tmp_path / "two.glb")
    mirrored, turned = sorted(read_mesh_file(tmp_path / "two.glb"), key=volume, reverse=True)
    assert np.ptp(mirrored.vertices, axis=0) == pytest.approx([0.1, 0.4, 0.3])
    assert volume(mirrored) == pytest.approx(0.012)
    assert np.ptp(turned.vertices, axis=0) == pytest.approx([0.2, 0.1, 0.3])
    assert turned.vertices.mean(axis=0) == pytest.approx([1.0, 2.0, 3.0])
    assert volume(turned) == pytest.approx(0.006)


def test_a_part_has_the_colour_of_most_of_its_faces(tmp_path):
    box = trimesh.creation.box([0.1, 0.2, 0.3])
    box.visual.face_colors = [[255, 0, 0, 255]] * 8 + [[0, 0, 255, 255]] * 4
    box.export(tmp_path / "red.ply")
    (part,) = read_mesh_file(tmp_path / "red.ply")
    assert part.rgba == (1.0, 0.0, 0.0, 1.0)


def test_corners_are_merged_in_seven_times_their_memory():
    corners = np.random.default_rng(0).random((60_000, 3), dtype=np.float32)
    tracemalloc.start()
    merged(corners)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 7 * corners.nbytes


CORNERS = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (1, 2, 0), (0, 2, 0), (1, 1, 1)]
FACES = [(4, 3, 2, 1, 0), *((n, (n + 1) % 5, 5) for n in range(5))]
"""A pyramid on five corners."""


def binary_ply():
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        "element vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 6\nproperty list uchar int vertex_indices\nend_header\n"
    )
    points = struct.pack("<18f", *np.ravel(CORNERS))
    faces = (struct.pack(f"<B{len(face)}i", len(face), *face) for face in FACES)
    return header.encode() + points + b"".join(faces)


def off():
    rows = [*CORNERS, *((len(face), *face) for face in FACES)]
    return "\n".join(["OFF", "6 6 0", *(" ".join(map(str, row)) for row in rows)]).encode()


@pytest.mark.parametrize(("suffix", "write"), [("ply", binary_ply), ("off", off)])
def test_faces_of_different_sizes_that_trimesh_does_not_read_are_explained(tmp_path, suffix, write):
    (tmp_path / f"a.{suffix}").write_bytes(write())
    with pytest.raises(MeshFileError, match="different numbers of corners, export it as triangles"):
        read_mesh_file(tmp_path / f"a.{suffix}")


OUTLINES = {
    "notch": [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)],
    "hexagon": [(1, 0), (2, 0), (3, 1), (2, 2), (1, 2), (0, 1)],
}


def prism(outline, binary):
    """Return a PLY file of a prism over an outline of six corners: of its ends alone if binary."""
    points = [(x, y, z) for z in (0, 1) for x, y in outline]
    faces = [[5, 4, 3, 2, 1, 0], [6, 7, 8, 9, 10, 11]]
    if not binary:
        faces += [[i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i] for i in range(6)]
    head = (
        f"ply\nformat {'binary_little_endian' if binary else 'ascii'} 1.0\n"
        "element vertex 12\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    ).encode()
    if binary:
        body = b"".join(struct.pack("<fff", *point) for point in points)
        return head + body + b"".join(struct.pack("<B6i", 6, *face) for face in faces)
    rows = [*points, *([len(face), *face] for face in faces)]
    return head + "".join(" ".join(map(str, row)) + "\n" for row in rows).encode()


@pytest.mark.parametrize("binary", [False, True])
def test_a_ply_file_with_a_notched_face_is_refused_and_a_convex_one_read(tmp_path, binary):
    file = tmp_path / "prism.ply"
    file.write_bytes(prism(OUTLINES["notch"], binary))
    with pytest.raises(MeshFileError, match="a face has a notch; export the mesh as triangles"):
        read_mesh_file(file)
    file.write_bytes(prism(OUTLINES["hexagon"], binary))
    (read,) = read_mesh_file(file)
    assert len(read.faces) == (8 if binary else 20)


@pytest.mark.parametrize("head", ["OFF\n# a prism's ends\n12 2 0\n", "OFF 12 2 0\n"])
def test_an_off_file_with_a_notched_face_is_refused_and_a_convex_one_read(tmp_path, head):
    file = tmp_path / "ends.off"
    faces = "6 5 4 3 2 1 0\n6 6 7 8 9 10 11\n"
    for outline, notched in (("notch", True), ("hexagon", False)):
        points = "".join(f"{x} {y} {z}\n" for z in (0, 1) for x, y in OUTLINES[outline])
        file.write_text(head + points + faces)
        if notched:
            with pytest.raises(MeshFileError, match="a face has a notch"):
                read_mesh_file(file)
        else:
            (read,) = read_mesh_file(file)
            assert len(read.faces) == 8


def measures(vertices, faces):
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    return [mesh.area, mesh.volume, *np.ravel(mesh.bounds)]


def measures_of_mujoco(path):
    spec = mujoco.MjSpec()
    spec.add_mesh(name="m", file=str(path))
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="m")
    model = spec.compile()
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, model.mesh_quat[0])
    return measures(model.mesh_vert @ rotation.reshape(3, 3).T + model.mesh_pos[0], model.mesh_face)


@pytest.mark.parametrize("kind", ["stl", "stl_ascii"])
def test_area_volume_and_bounds_are_those_that_mujoco_reads(tmp_path, kind):
    ring = trimesh.creation.annulus(0.1, 0.3, 0.5)
    ring.apply_translation([1.0, 2.0, 3.0])
    ring.export(tmp_path / "binary.stl")
    ring.export(tmp_path / "ring.stl", file_type=kind)
    (part,) = read_mesh_file(tmp_path / "ring.stl")
    ours = measures(part.vertices, part.faces)
    assert ours == pytest.approx(measures_of_mujoco(tmp_path / "binary.stl"), rel=1e-5)
