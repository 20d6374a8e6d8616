"""Mesh files of every format, as links of a model."""

import json
import struct
import zipfile

import mujoco
import numpy as np
import pytest
import trimesh

from arm_description import ResourceFinder
from arm_gazebo.errors import MeshError, ModelError
from arm_gazebo.mesh.part import MeshPart

SIZE = (0.1, 0.2, 0.3)
RED, GREEN = (1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0)

COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="millimeter" meter="0.001"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 100 0 0 0 200 0 0 0 300</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 1 2 3 0 3 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""

TWO_COLOURS = """mtllib two.mtl
v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 2 0 0\nv 3 0 0\nv 2 1 0\nv 2 0 1
usemtl red\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3
usemtl green\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7
"""

# The directory of an archive: one file, which takes version 25.5 of the format to read it.
ZIP_OF_LATER = struct.pack("<4sBBBB38x", b"PK\1\2", 20, 3, 255, 0) + struct.pack(
    "<4s4xHHLLH", b"PK\5\6", 1, 1, 46, 0, 0
)


def shape(uri, scale="1 1 1", tag="visual", colour=""):
    return f'<{tag}><geometry><mesh filename="{uri}" scale="{scale}"/></geometry>{colour}</{tag}>'


def robot_with(*shapes):
    return (
        '<robot name="r"><link name="base"><inertial><mass value="1"/><inertia ixx="1" iyy="1" '
        f'izz="1" ixy="0" ixz="0" iyz="0"/></inertial>{"".join(shapes)}</link></robot>'
    )


def extent(model, geom=-1):
    """Return the size in m of the box around a mesh geom."""
    mesh = model.geom_dataid[geom]
    first = model.mesh_vertadr[mesh]
    vertices = model.mesh_vert[first : first + model.mesh_vertnum[mesh]]
    rotation = np.zeros(9)
    mujoco.mju_quat2Mat(rotation, model.geom_quat[geom])
    return np.ptp(vertices @ rotation.reshape(3, 3).T, axis=0)


@pytest.fixture
def box():
    return trimesh.creation.box(SIZE)


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply", "glb", "off"])
def test_formats(parts, tmp_path, box, suffix):
    file = tmp_path / f"box.{suffix}"
    box.export(file)
    model = parts.build(robot_with(shape(file))).model
    assert extent(model) == pytest.approx(SIZE, abs=1e-6)


def test_binary_stl_that_starts_like_text(parts, tmp_path, box):
    data = bytearray(box.export(file_type="stl"))
    data[:6] = b"solid "
    (tmp_path / "box.stl").write_bytes(data)
    model = parts.build(robot_with(shape(tmp_path / "box.stl"))).model
    assert extent(model) == pytest.approx(SIZE, abs=1e-6)


def test_materials_of_an_obj_are_separate_colours(parts, tmp_path):
    (tmp_path / "two.obj").write_text(TWO_COLOURS)
    (tmp_path / "two.mtl").write_text("newmtl red\nKd 1 0 0\nnewmtl green\nKd 0 1 0\n")
    model = parts.build(robot_with(shape(tmp_path / "two.obj"))).model
    colours = {tuple(np.round(rgba, 2)) for rgba in model.geom_rgba[-2:]}
    assert colours == {RED, GREEN}


def test_colour_of_the_urdf_beats_the_one_colour_of_a_file(parts, tmp_path):
    (tmp_path / "one.obj").write_text(TWO_COLOURS.partition("usemtl green")[0])
    (tmp_path / "two.mtl").write_text("newmtl red\nKd 1 0 0\n")
    green = '<material name="g"><color rgba="0 1 0 1"/></material>'
    model = parts.build(robot_with(shape(tmp_path / "one.obj", colour=green))).model
    assert model.geom_rgba[-1] == pytest.approx(GREEN)


def test_scale(parts, tmp_path, box):
    box.export(tmp_path / "box.stl")
    model = parts.build(robot_with(shape(tmp_path / "box.stl", "10 1 0.5"))).model
    assert extent(model) == pytest.approx([1.0, 0.2, 0.15], abs=1e-6)


@pytest.mark.parametrize(
    ("scale", "reason"),
    [
        ("1e9 1e9 1e9", "it extends 1.5e+08 m from its origin"),
        ("0 0 0", "only 0 m large"),
        ("1e-9 0 0", "only"),
    ],
)
def test_scale_that_no_part_can_have_is_a_missing_mesh(parts, tmp_path, box, scale, reason):
    box.export(tmp_path / "box.stl")
    uses = [shape(tmp_path / "box.stl", scale, tag) for tag in ("visual", "collision")]
    [warning] = parts.build(robot_with(*uses)).report.warnings
    assert reason in warning.message


def test_mirrored_mesh_keeps_its_outside_outside(parts, tmp_path):
    wedge = trimesh.creation.cone(0.1, 0.3)
    wedge.export(tmp_path / "cone.stl")
    model = parts.build(robot_with(shape(tmp_path / "cone.stl", "1 1 -1"))).model
    mesh = model.geom_dataid[-1]
    vertices = model.mesh_vert[model.mesh_vertadr[mesh] :][: model.mesh_vertnum[mesh]]
    faces = model.mesh_face[model.mesh_faceadr[mesh] :][: model.mesh_facenum[mesh]]
    assert trimesh.Trimesh(vertices, faces, process=False).volume > 0


def test_one_file_is_one_asset_however_often_it_is_used(parts, tmp_path, box):
    box.export(tmp_path / "box.stl")
    use = shape(tmp_path / "box.stl")
    model = parts.build(robot_with(use, use, shape(tmp_path / "box.stl", tag="collision"))).model
    assert model.nmesh == 1


def test_files_of_the_same_name_in_two_folders_are_two_meshes(parts, tmp_path):
    for folder, size in (("a", 0.1), ("b", 0.2)):
        (tmp_path / folder).mkdir()
        trimesh.creation.box([size] * 3).export(tmp_path / folder / "part.stl")
    uses = [shape(tmp_path / folder / "part.stl") for folder in "ab"]
    model = parts.build(robot_with(*uses)).model
    assert extent(model, -2) == pytest.approx([0.1] * 3, abs=1e-6)
    assert extent(model, -1) == pytest.approx([0.2] * 3, abs=1e-6)


def test_package_path_is_searched(parts, tmp_path, box):
    (tmp_path / "my_robot" / "meshes").mkdir(parents=True)
    box.export(tmp_path / "my_robot" / "meshes" / "box.stl")
    urdf = robot_with(shape("package://my_robot/meshes/box.stl"))
    assert parts.build(urdf, resources=ResourceFinder(None, (tmp_path,))).report.findings == ()


def test_a_missing_mesh_becomes_a_box_and_a_warning_with_the_searched_paths(parts, tmp_path):
    urdf = robot_with(shape("package://my_robot/box.stl"))
    built = parts.build(urdf, resources=ResourceFinder(None, (tmp_path,)))
    [warning] = [str(finding) for finding in built.report.warnings]
    assert "link 'base' (line 1): no file for 'package://my_robot/box.stl'" in warning
    assert str(tmp_path / "my_robot" / "box.stl") in warning
    assert built.model.geom_size[-1] == pytest.approx([0.025] * 3)


def test_the_folders_that_lack_a_package_are_listed_once(parts, tmp_path):
    names = ("package://gone/a.stl", "package://gone/b.stl", "package://other/a.stl", "c.stl")
    built = parts.build(robot_with(*map(shape, names)), resources=ResourceFinder(None, (tmp_path,)))
    first, second, third, fourth = [finding.message for finding in built.report.warnings]
    for each, place in ((first, "gone/a.stl"), (third, "other/a.stl"), (fourth, "c.stl")):
        assert f"\n  {tmp_path / place}\n" in each
        assert each.endswith("\n  a box of 5 cm replaces it")
    said = (
        "no file for 'package://gone/b.stl' in the same folders, either; a box of 5 cm replaces it"
    )
    assert second == said


def test_missing_mesh_is_an_error_when_strict(parts):
    with pytest.raises(MeshError, match=r"link 'base' \(line 1\): no file for 'gone.stl'"):
        parts.build(robot_with(shape("gone.stl")), strict=True)


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("a.stl", b"", "neither a text STL nor a complete binary one"),
        ("a.stl", b"\0" * 80 + struct.pack("<I", 100) + b"\0" * 20, "nor a complete binary one"),
        ("a.stl", b"solid x\nvertex 1 2 3\nendsolid", "vertices, 1, is not a multiple of 3"),
        ("a.stl", b"solid x\nvertex 1 2 x\nvertex 1 2 3\nvertex 1 2 3\n", "invalid coordinate"),
        ("a.obj", b"v 1 2 3\n", ""),
        ("a.dae", b"<COLLADA", ""),
        ("a.3mf", b"PK", "it is not a ZIP file"),
        ("a.3mf", ZIP_OF_LATER, "zip file version 25.5"),
        ("a.step", b"ISO-10303", "'.step' is not one of .stl, .obj"),
    ],
)
def test_unreadable_mesh_is_named_with_the_reason(parts, tmp_path, name, content, reason):
    (tmp_path / name).write_bytes(content)
    built = parts.build(robot_with(shape(tmp_path / name)))
    [warning] = [str(finding) for finding in built.report.warnings]
    assert f"cannot use the mesh {tmp_path / name}: " in warning
    assert reason in warning


@pytest.mark.parametrize(
    "entity", ["<!ENTITY a 'x'><!ENTITY e '&a;&a;'>", "<!ENTITY e SYSTEM '{secret}'>"]
)
def test_entities_of_a_collada_file_neither_multiply_nor_read_files(parts, tmp_path, entity):
    (tmp_path / "secret").write_text("known")
    doctype = f"<!DOCTYPE COLLADA [{entity.format(secret=tmp_path / 'secret')}]>"
    head, _, rest = COLLADA.partition("\n")
    (tmp_path / "a.dae").write_text(
        f"{head}{doctype}{rest.replace('<up_axis>', '<title>&e;</title><up_axis>')}"
    )
    built = parts.build(robot_with(shape(tmp_path / "a.dae")))
    [warning] = [str(finding) for finding in built.report.warnings]
    assert f"cannot use the mesh {tmp_path / 'a.dae'}: " in warning
    assert "known" not in warning


def used(times, node):
    return f'<instance_node url="#{node}"/>' * times


@pytest.mark.parametrize(
    ("innermost", "depth", "reason"),
    [
        ('<instance_geometry url="#g"/>', 9, "it draws more than 10000 geometries"),
        ('<instance_geometry url="#g"/>', 2000, "its nodes use each other more than 100 deep"),
        (used(1, "n9"), 9, "uses itself"),
        ("", 12, "its nodes are used more than 100000 times in all"),
    ],
)
def test_nodes_of_a_collada_file_do_not_multiply_either(parts, tmp_path, innermost, depth, reason):
    nodes = "".join(f'<node id="n{n}">{used(10, f"n{n - 1}")}</node>' for n in range(1, depth + 1))
    library = f'<library_nodes><node id="n0">{innermost}</node>{nodes}</library_nodes>'
    text = COLLADA.replace(
        '<node id="n"><instance_geometry url="#g"/>', f'<node id="n">{used(1, f"n{depth}")}'
    )
    text = text.replace("<library_visual_scenes>", f"{library}<library_visual_scenes>")
    (tmp_path / "a.dae").write_text(text)
    built = parts.build(robot_with(shape(tmp_path / "a.dae")))
    [warning] = [str(finding) for finding in built.report.warnings]
    assert reason in warning


def warning_of(parts, file):
    """Return the single finding about an unusable mesh file."""
    built = parts.build(robot_with(shape(file)))
    [warning] = [str(finding) for finding in built.report.warnings]
    assert f"cannot use the mesh {file}: " in warning
    return warning


DRAWS, USES_ITSELF = "it draws more than 10000 geometries", "its node '0' uses itself"
DEEP = "its nodes use each other more than 100 deep"


@pytest.mark.parametrize(
    ("nodes", "reason"),
    [
        ([{"children": [1]}, {"children": [0], "mesh": 0}], USES_ITSELF),
        ([*({"children": [n + 1] * 10} for n in range(9)), {"mesh": 0}], DRAWS),
        ([{"children": [*range(1, 10_002)]}, *([{"mesh": 0}] * 10_001)], DRAWS),
        ([*({"children": [n + 1]} for n in range(3000)), {"mesh": 0}], DEEP),
    ],
)
def test_nodes_of_a_gltf_file_do_not_multiply(parts, tmp_path, nodes, reason):
    document = {"scenes": [{"nodes": [0]}], "nodes": nodes, "meshes": [{"primitives": [{}]}]}
    (tmp_path / "a.gltf").write_text(json.dumps(document))
    assert reason in warning_of(parts, tmp_path / "a.gltf")


@pytest.mark.parametrize(
    ("document", "reason"),
    [
        ({"accessors": [{"count": 10**11}] * 2}, "200000000000 of its elements have no data"),
        (
            {"buffers": [{"uri": "/dev/zero"}]},
            "it names '/dev/zero': it is a device, not a regular file",
        ),
        ({"images": [{"uri": "a" * 5000}]}, "it names 'aaa"),
        ([], "it is not glTF: its JSON is not an object"),
    ],
)
def test_a_gltf_file_with_an_absurd_size_is_not_read(parts, tmp_path, document, reason):
    (tmp_path / "a.gltf").write_text(json.dumps(document))
    assert reason in warning_of(parts, tmp_path / "a.gltf")


def test_brackets_of_a_gltf_file_that_never_end(parts, tmp_path):
    (tmp_path / "a.gltf").write_text("[" * 100_000)
    assert "its JSON is nested too deep" in warning_of(parts, tmp_path / "a.gltf")


def components(*ids):
    inside = "".join(f'<component objectid="{n}"/>' for n in ids)
    return f"<components>{inside}</components>"


@pytest.mark.parametrize(
    ("objects", "items", "reason"),
    [
        ([components(1), components(0)], [0], USES_ITSELF),
        ([*(components(*([n + 1] * 10)) for n in range(9)), "<mesh/>"], [0], DRAWS),
        ([components(*([1] * 10)), components(*["elsewhere"] * 1001)], [0], DRAWS),
        (["<mesh/>"], [0] * 10_001, DRAWS),
        ([*(components(n + 1) for n in range(3000)), "<mesh/>"], [0], DEEP),
    ],
)
def test_components_of_a_3mf_file_do_not_multiply(parts, tmp_path, objects, items, reason):
    resources = "".join(f'<object id="{n}">{text}</object>' for n, text in enumerate(objects))
    build = "".join(f'<item objectid="{n}"/>' for n in items)
    with zipfile.ZipFile(tmp_path / "a.3mf", "w", zipfile.ZIP_DEFLATED) as archive:
        model = f"<model><resources>{resources}</resources><build>{build}</build></model>"
        archive.writestr("3D/3dmodel.model", model)
    assert reason in warning_of(parts, tmp_path / "a.3mf")


def test_a_packed_mesh_that_unpacks_beyond_all_bounds_is_not_read(parts, tmp_path, monkeypatch):
    monkeypatch.setattr("arm_description.mesh.file.LARGEST_BYTES", 100_000)
    with zipfile.ZipFile(tmp_path / "a.3mf", "w", zipfile.ZIP_DEFLATED) as archive:
        for name in ("a", "b"):
            archive.writestr(name, bytes(60_000))
    assert (tmp_path / "a.3mf").stat().st_size < 1_000
    built = parts.build(robot_with(shape(tmp_path / "a.3mf")))
    [warning] = [str(finding) for finding in built.report.warnings]
    assert "it unpacks to 120000 bytes; at most 100000 are read" in warning


def test_flat_visual_is_drawn(parts, tmp_path):
    sheet = trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    sheet.export(tmp_path / "sheet.stl")
    built = parts.build(robot_with(shape(tmp_path / "sheet.stl")))
    assert built.report.findings == ()


def test_flat_collision_becomes_a_thin_box(parts, tmp_path):
    sheet = trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    sheet.export(tmp_path / "sheet.stl")
    built = parts.build(robot_with(shape(tmp_path / "sheet.stl", tag="collision")))
    assert "is flat; its bounding box is used" in str(built.report.warnings[0])
    assert built.model.geom_size[-1] == pytest.approx([0.5, 0.5, 1e-4])
    assert built.model.geom_pos[-1] == pytest.approx([0.5, 0.5, 0])


def sheet(thickness, turned, offset):
    """Return a sheet of 10 cm, turned out of the axes' planes or not."""
    solid = trimesh.creation.box([0.1, 0.1, thickness])
    if turned:
        solid.apply_transform(trimesh.transformations.rotation_matrix(0.7, [1, 2, 3]))
    solid.apply_translation([offset] * 3)
    return solid


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("offset", [0.0, 1.0, 10.0])
@pytest.mark.parametrize("thickness", [1e-4, 1e-6, 1e-7, 1e-9, 0.0])
def test_a_sheet_however_thin_can_be_touched(parts, tmp_path, thickness, offset, turned):
    """MuJoCo refuses a whole world for one mesh without a convex hull."""
    # A text format with all digits: binary STL would round them.
    (tmp_path / "sheet.obj").write_text(
        trimesh.exchange.obj.export_obj(sheet(thickness, turned, offset), digits=17)
    )
    built = parts.build(robot_with(shape(tmp_path / "sheet.obj", tag="collision")))
    geom = built.model.ngeom - 1
    # A turned sheet does not become a cube. MuJoCo turns the box around it as it likes.
    thin, *sides = sorted(built.model.geom_aabb[geom, 3:])
    assert thin < 1e-3
    assert all(0.049 < side < 0.072 for side in sides)


@pytest.mark.parametrize("turned", [False, True])
def test_a_fine_sheet_can_be_touched(parts, tmp_path, turned):
    """It has so many vertices that only the outermost ones are collided with."""
    grid = np.stack(np.meshgrid(np.linspace(0, 0.1, 40), np.linspace(0, 0.1, 40), [0.0]), -1)
    points = grid.reshape(-1, 3)
    corners = [[n, n + 1, n + 40] for n in range(len(points) - 41)]
    fine = trimesh.Trimesh(points, corners)
    if turned:
        fine.apply_transform(trimesh.transformations.rotation_matrix(0.7, [1, 2, 3]))
    fine.export(tmp_path / "fine.stl")
    built = parts.build(robot_with(shape(tmp_path / "fine.stl", tag="collision")))
    thin, *sides = sorted(built.model.geom_aabb[built.model.ngeom - 1, 3:])
    assert thin < 1e-3
    assert all(0.049 < side < 0.072 for side in sides)


def test_a_flat_part_beside_a_fine_one_can_be_touched(parts, tmp_path):
    ball = trimesh.creation.icosphere(4, 0.1)
    lines = ["mtllib two.mtl", "usemtl red"]
    lines += [f"v {x} {y} {z}" for x, y, z in ball.vertices]
    lines += [f"f {a} {b} {c}" for a, b, c in ball.faces + 1]
    lines += ["v 1 0 0", "v 1.1 0 0", "v 1.1 0.1 0", "v 1 0.1 0", "usemtl green", "f -4 -3 -2 -1"]
    (tmp_path / "two.obj").write_text("\n".join(lines))
    (tmp_path / "two.mtl").write_text("newmtl red\nKd 1 0 0\nnewmtl green\nKd 0 1 0\n")
    built = parts.build(robot_with(shape(tmp_path / "two.obj", tag="collision")))
    assert "a part of its collision mesh" in str(built.report.warnings[0])
    assert built.model.geom_size[-1] == pytest.approx([0.05, 0.05, 1e-4])


@pytest.mark.parametrize("seed", range(8))
def test_meshes_without_a_hull_are_found_before_mujoco_fails(parts, tmp_path, seed):
    random = np.random.default_rng(seed)
    shapes = []
    for number in range(25):
        vertices = random.uniform(-1, 1, (random.integers(4, 40), 3))
        vertices *= 10.0 ** random.uniform(-9, 0, 3)
        turn = trimesh.transformations.random_rotation_matrix(random.uniform(size=3))[:3, :3]
        vertices = vertices @ turn.T + random.uniform(-1, 1, 3) * 10.0 ** random.uniform(-3, 2)
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
        (tmp_path / f"{number}.obj").write_text("\n".join([*lines, "f 1 2 3", "f 1 2 4"]))
        shapes.append(shape(tmp_path / f"{number}.obj", tag="collision"))
    built = parts.build(robot_with(*shapes))
    assert built.model.ngeom >= len(shapes)


def test_a_mesh_that_mujoco_refuses_is_named(parts, tmp_path, monkeypatch):
    file = tmp_path / "sheet.obj"
    sheet(0.0, True, 0.0).export(file)
    monkeypatch.setattr(MeshPart, "is_flat", lambda _self: False)
    with pytest.raises(
        ModelError, match=rf"coplanar vertices.* file {file}, link 'base' \(line 1\)"
    ):
        parts.build(robot_with(shape(file, tag="collision")))
