"""OBJ files of every valid form, against their known shapes and MuJoCo's own reader."""

import random

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mesh_measures import measures

from arm_description.errors import MeshFileError
from arm_description.mesh.file import read_mesh_file

L_OUTLINE = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 3), (0, 3)]
"""Of area 4: a notch is missing in the upper right."""
COMB = [(0, 0), (7, 0), (7, 3), (6, 3), (6, 1), (5, 1), (5, 3), (4, 3), (4, 1), (0, 1)]
"""Of area 11: two teeth on a bar."""
SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
AREAS = {"square": (SQUARE, 1.0), "l": (L_OUTLINE, 4.0), "comb": (COMB, 11.0)}
HEIGHT = 2.0


def prism(outline: list[tuple[float, float]]) -> tuple[list[tuple[float, ...]], list[list[int]]]:
    """Return the points of a prism and its faces, numbered from 0, seen from outside."""
    n = len(outline)
    points = [(x, y, z) for z in (0.0, HEIGHT) for x, y in outline]
    sides = [[i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)]
    return points, [list(range(n - 1, -1, -1)), list(range(n, 2 * n)), *sides]


def measures_of_mujoco(path) -> tuple[float, float]:
    spec = mujoco.MjSpec()
    spec.add_mesh(name="m", file=str(path))
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="m")
    model = spec.compile()
    a, b, c = np.moveaxis(model.mesh_vert[model.mesh_face].astype(float), 1, 0)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    return area, np.einsum("fk,fk->f", a, np.cross(b, c)).sum() / 6


def written(points, faces, seed: int, form: str, relative: str, order: str) -> str:
    """Return an OBJ file's text.

    Args:
        seed: chooses the first corner of each face, blanks, and which indices are relative.
        form: of a corner, such as v//vn.
        relative: "never", "always" or "mixed".
        order: whether the vertices come "first", just "before" the face that needs them, or
            "again" before each face.
    """
    chance = random.Random(seed)
    lines, known = ["# written by a test", "o part"], {}
    lines += [line for line in ("vt 0 0", "vn 0 0 1") if line[:2] in form]
    count = 0

    def add(index: int) -> None:
        nonlocal count
        count += 1
        known[index] = count
        blank = chance.choice([" ", "  ", "\t"])
        lines.append(f"v{blank}" + " ".join(repr(float(x)) for x in points[index]))

    if order == "first":
        for index in range(len(points)):
            add(index)
    for face in faces:
        start = chance.randrange(len(face))
        face = face[start:] + face[:start]
        for index in face:
            if order == "again" or index not in known:
                add(index)
        corners = []
        for index in face:
            back = relative == "always" or (relative == "mixed" and chance.random() < 0.5)
            number = known[index] - count - 1 if back else known[index]
            other = "-1" if back else "1"
            corners.append(form.replace("vt", other).replace("vn", other).replace("v", str(number)))
        text = "f " + " ".join(corners)
        lines += [chance.choice(["", "g side", "s 1", "s off"]), text + chance.choice(["", " "])]
    return "\n".join(lines) + "\n"


@settings(max_examples=60)
@given(
    shape=st.sampled_from(sorted(AREAS)),
    seed=st.integers(0, 10**6),
    form=st.sampled_from(["v", "v/vt", "v//vn", "v/vt/vn"]),
    relative=st.sampled_from(["never", "always", "mixed"]),
    order=st.sampled_from(["first", "before", "again"]),
)
def test_every_form_is_read_as_it_is_meant(tmp_path_factory, shape, seed, form, relative, order):
    outline, floor = AREAS[shape]
    points, faces = prism(outline)
    path = tmp_path_factory.mktemp("obj") / "part.obj"
    path.write_text(written(points, faces, seed, form, relative, order))
    area, volume, low, high = measures(read_mesh_file(path))
    around = sum(
        np.hypot(*np.subtract(a, b))
        for a, b in zip(outline, outline[1:] + outline[:1], strict=True)
    )
    assert area == pytest.approx(2 * floor + around * HEIGHT)
    assert volume == pytest.approx(floor * HEIGHT)
    assert [low, high] == [np.min(points, axis=0).tolist(), np.max(points, axis=0).tolist()]
    if shape == "square" and form == "v":
        # MuJoCo cuts a notch wrongly, wants a normal for each corner, and reads one group.
        lines = [line for line in path.read_text().splitlines() if line[:1] in ("v", "f")]
        path.write_text("\n".join(" ".join(line.split()) for line in lines))
        assert measures_of_mujoco(path) == pytest.approx((area, volume), rel=1e-5)


@pytest.mark.parametrize(
    ("lines", "opacity"),
    [
        ("", 1.0),
        ("d 0.25", 0.25),
        ("Tr 0.75", 0.25),
        ("d -halo 0.25", 0.25),
        ("d 0.25\nTr 0.25", 0.25),
        ("d 7", 1.0),
        ("d much", 1.0),
    ],
)
def test_a_material_has_its_opacity(tmp_path, lines, opacity):
    material = f"newmtl glass\nKd 0.5 0.25 1\n{lines}\nnewmtl other\n Kd 0 1 0\n d 0.5\n"
    (tmp_path / "some colours.mtl").write_text(material)
    points, faces = prism(SQUARE)
    text = written(points, faces, 0, "v", "never", "first")
    (tmp_path / "window.obj").write_text("mtllib some colours.mtl\nusemtl glass\n" + text)
    (part,) = read_mesh_file(tmp_path / "window.obj")
    assert part.rgba == pytest.approx((0.5, 0.25, 1.0, opacity))


def test_the_faces_of_one_material_are_one_part(tmp_path):
    (tmp_path / "a.mtl").write_text("newmtl a\nKd 1 0 0\n")
    (tmp_path / "b.mtl").write_text("newmtl b\nKd 0 0 1\n")
    vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    path = tmp_path / "tetrahedron.obj"
    path.write_text(
        "mtllib a.mtl b.mtl\nmtllib ../outside.mtl\n" + vertices + "f 1 3 2\nusemtl b\nf 1 2 4\n"
        "usemtl a\nf 1 4 3\nusemtl b\nf 2 3 4\nusemtl nothing\nf 1 2 3\n"
    )
    plain, second, first, lost = read_mesh_file(path)
    assert (len(plain.faces), plain.rgba) == (1, None)
    assert (len(second.faces), second.rgba) == (2, (0, 0, 1, 1))
    assert (len(first.faces), first.rgba) == (1, (1, 0, 0, 1))
    assert (len(lost.faces), lost.rgba) == (1, None)


def test_colours_of_vertices_are_read(tmp_path):
    path = tmp_path / "scan.obj"
    colors = ["1 0 0", "1 0 0", "0 1 0", "1 0 0"]
    places = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"]
    lines = [f"v {place} {color}" for place, color in zip(places, colors, strict=True)]
    path.write_text("\n".join([*lines, "f 1 2 3", "f 1 2 4", "l 1 2", "p 1"]))
    (part,) = read_mesh_file(path)
    assert part.rgba == (1.0, 0.0, 0.0, 1.0)
    assert part.bounds[1].tolist() == [1, 1, 1]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("f 1 2 4", "a vertex that does not exist"),
        ("f 0 1 2", "a vertex that does not exist"),
        ("f -4 1 2", "a vertex that does not exist"),
        ("f 1 two 3", "a face's vertex is not a number"),
        ("f 1 2 99999999999999999999", "not"),
        ("v 1 2\nf 1 2 3", "lacks coordinates"),
        ("v 1 2 x\nf 1 2 3", "a coordinate is not a number"),
        ("f 1 2\nl 1 2", "no triangles in it"),
        ("", "no triangles in it"),
    ],
)
def test_a_broken_file_gets_a_sentence(tmp_path, text, problem):
    path = tmp_path / "broken.obj"
    path.write_text(f"v 0 0 0\nv 1 0 0\nv 0 1 0\n{text}\n")
    with pytest.raises(MeshFileError, match=problem):
        read_mesh_file(path)


def test_a_long_line_goes_on_after_a_backslash(tmp_path):
    path = tmp_path / "long.obj"
    path.write_text("v 0 0 0\nv 1 0 \\\n0\nv 1 1 0\nv 0 1 0\nf 1 2 \\\r\n3 4\n")
    assert measures(read_mesh_file(path))[0] == 1.0


def test_an_outline_that_crosses_itself_is_read(tmp_path):
    path = tmp_path / "bow.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nf 1 2 3 4\nf 1 2 5\nf 1 1 1 1\n")
    (part,) = read_mesh_file(path)
    assert len(part.faces) == 5
