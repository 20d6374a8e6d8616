"""COLLADA files of every valid layout, against the shape that was written."""

import numpy as np
import pytest
from mesh_measures import measures

from arm_description.errors import MeshFileError
from arm_description.mesh.file import read_mesh_file

L_OUTLINE = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 3), (0, 3)]
"""Of area 4: a notch is missing in the upper right."""
AREA, VOLUME, HIGH = 2 * 4 + 10 * 2, 4 * 2, [2, 3, 2]
"""Of the prism of height 2 over that outline."""
POINTS = [(x, y, z) for z in (0, 2) for x, y in L_OUTLINE]
FACES = [
    [5, 4, 3, 2, 1, 0],
    [6, 7, 8, 9, 10, 11],
    *([i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i] for i in range(6)),
]
FLAT = ((5, 3, 0), (5, 4, 3), (3, 2, 0), (2, 1, 0))
"""The triangles of the first face."""
DOCUMENT = """<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="{unit}"/></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert>
<!-- seen from both sides --><diffuse><color>1 0 0 1</color></diffuse>{opacity}</lambert>
</technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>{sources}
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>{faces}</mesh></geometry>
</library_geometries>
<library_visual_scenes><visual_scene id="s">{nodes}</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""
DRAWN = """<instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="m" target="#m"/></technique_common></bind_material>
</instance_geometry>"""


def source(name: str, array: str, values, accessor: str, parameters: str) -> str:
    numbers = [repr(float(value)) for value in np.ravel(values)]
    text = " ".join(numbers)
    own = f'<float_array id="{array}" count="{len(numbers)}">{text}</float_array>'
    return (
        f'<source id="{name}">{own if len(numbers) else ""}<technique_common>'
        f'<accessor source="#{array}" {accessor}>{parameters}</accessor></technique_common>'
        "</source>"
    )


def parameters(*names: str) -> str:
    return "".join(
        f'<param name="{name}" type="float"/>' if name else '<param type="float"/>'
        for name in names
    )


XYZ = parameters("X", "Y", "Z")
PLAIN = source("p", "a", POINTS, 'count="12" stride="3"', XYZ)
NORMALS = source("n", "na", [(0, 0, 1)], 'count="1" stride="3"', XYZ)
ROWS_OF_FOUR = np.hstack([POINTS, np.full((12, 1), 7.0)])
SOURCES = {
    "plain": PLAIN,
    "offset": source("p", "a", [9, 9, *np.ravel(POINTS)], 'count="12" offset="2" stride="3"', XYZ),
    "stride": source("p", "a", ROWS_OF_FOUR, 'count="12" stride="4"', XYZ),
    "nameless": source(
        "p",
        "a",
        np.roll(ROWS_OF_FOUR, 1, axis=1),
        'count="12" stride="4"',
        parameters("", "X", "Y", "Z"),
    ),
    "shared": source("p", "b", [], 'count="12" offset="3" stride="6"', XYZ)
    + source("q", "b", np.hstack([np.full((12, 3), 7.0), POINTS]), 'count="12" stride="6"', XYZ),
    "longer": source("p", "a", [*np.ravel(POINTS), 5, 5, 5], 'count="12" stride="3"', XYZ),
}


def faces(kind: str, form: str, turned: int = 0) -> str:
    """Return the faces as one element, or some for strips and fans.

    Args:
        kind: of the element.
        form: "v" for indices of vertices alone, "vn" and "nv" with normals behind and before.
        turned: by how many corners each face is turned.
    """
    polygons = [face[turned % len(face) :] + face[: turned % len(face)] for face in FACES]
    inputs = {
        "v": '<input semantic="VERTEX" source="#v" offset="0"/>',
        "vn": '<input semantic="VERTEX" source="#v" offset="0"/>'
        '<input semantic="NORMAL" source="#n" offset="1"/>',
        "nv": '<input semantic="NORMAL" source="#n" offset="0"/>'
        '<input semantic="VERTEX" source="#v" offset="1"/>',
    }[form]
    corner = {"v": "{}", "vn": "{} 0", "nv": "0 {}"}[form]

    def text(indices) -> str:
        return " ".join(corner.format(index) for index in indices)

    def element(name: str, rows, more: str = "") -> str:
        each = "".join(f"<p>{text(row)}</p>" for row in rows)
        return f'<{name} count="{len(rows)}" material="m">{inputs}{more}{each}</{name}>'

    if kind == "polygons":
        return element("polygons", polygons)
    if kind == "polylist":
        sizes = " ".join(str(len(face)) for face in polygons)
        return element(
            "polylist",
            [[index for face in polygons for index in face]],
            f"<vcount>{sizes}</vcount>",
        ).replace('count="1"', 'count="8"')
    # The lid is the floor, two higher and the other way round.
    flat = [*FLAT, *((c + 6, b + 6, a + 6) for a, b, c in FLAT)]
    if kind == "triangles":
        sides = [t for a, b, c, d in FACES[2:] for t in ((a, b, c), (a, c, d))]
        every = [index for triangle in (*flat, *sides) for index in triangle]
        return element("triangles", [every]).replace('count="1"', 'count="20"')
    if kind == "trifans":
        return element("trifans", [*flat, *FACES[2:]])
    return element("tristrips", [*flat, *((a, b, d, c) for a, b, c, d in FACES[2:])])


def write(path, sources=PLAIN, drawn="", nodes=f"<node>{DRAWN}</node>", unit="1", opacity=""):
    path.write_text(
        DOCUMENT.format(
            sources=sources + NORMALS,
            faces=drawn or faces("triangles", "v"),
            nodes=nodes,
            unit=unit,
            opacity=opacity,
        )
    )
    return path


@pytest.mark.parametrize("form", ["v", "vn", "nv"])
@pytest.mark.parametrize("kind", ["triangles", "polylist", "polygons", "trifans", "tristrips"])
@pytest.mark.parametrize("layout", SOURCES)
def test_every_layout_gives_the_shape(tmp_path, layout, kind, form):
    for turned in range(6 if kind.startswith("poly") else 1):
        path = write(tmp_path / "l.dae", SOURCES[layout], faces(kind, form, turned))
        area, volume, low, high = measures(read_mesh_file(path))
        assert (area, volume) == pytest.approx((AREA, VOLUME))
        assert (low, high) == ([0, 0, 0], HIGH)


@pytest.mark.parametrize(
    "nodes",
    [
        f"<node><matrix>0 -1 0 5 1 0 0 0 0 0 2 0 0 0 0 1</matrix>{DRAWN}</node>",
        "<node><translate>5 0 0</translate><rotate>0 0 1 90</rotate><scale>1 1 2</scale>"
        f"{DRAWN}</node>",
        "<node><translate>5 0 0</translate><node><rotate>0 0 1 90</rotate>"
        f"<node><scale>1 1 2</scale>{DRAWN}</node></node></node>",
    ],
    ids=["matrix", "parts", "nested"],
)
def test_nodes_move_what_they_draw(tmp_path, nodes):
    path = write(tmp_path / "l.dae", nodes=nodes, unit="0.1")
    _, volume, low, high = measures(read_mesh_file(path))
    assert volume == pytest.approx(2 * VOLUME / 1000, rel=1e-6)
    assert low == pytest.approx([0.2, 0, 0], abs=1e-6)
    assert high == pytest.approx([0.5, 0.2, 0.4], abs=1e-6)


@pytest.mark.parametrize(
    ("opacity", "expected"),
    [
        ("", 1.0),
        ("<transparency><float>0.3</float></transparency>", 0.3),
        ("<transparent><color>1 1 1 0.3</color></transparent>", 0.3),
        (
            "<transparent opaque='A_ONE'><color>0 0 0 0.6</color></transparent>"
            "<transparency><float>0.5</float></transparency>",
            0.3,
        ),
        ("<transparent opaque='RGB_ZERO'><color>0 0 0 0</color></transparent>", 1.0),
        (
            "<transparent opaque='RGB_ZERO'><color>0.7 0.7 0.7 1</color></transparent>"
            "<transparency><float>1</float></transparency>",
            0.3,
        ),
        ("<transparent opaque='RGB_ONE'><color>0.3 0.3 0.3 0</color></transparent>", 0.3),
        ("<transparent opaque='A_ZERO'><color>1 1 1 0.7</color></transparent>", 0.3),
    ],
)
def test_a_material_has_its_opacity(tmp_path, opacity, expected):
    (part,) = read_mesh_file(write(tmp_path / "l.dae", opacity=opacity))
    assert part.rgba == pytest.approx((1.0, 0.0, 0.0, expected), abs=3e-3)


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({"sources": SOURCES["offset"].replace('offset="2"', 'offset="5"')}, "too short"),
        ({"sources": SOURCES["stride"].replace('stride="4"', 'stride="-4"')}, "not a whole number"),
        ({"drawn": faces("polylist", "v").replace("<vcount>6", "<vcount>7")}, "number of corners"),
        ({"drawn": faces("polygons", "v").replace("<p>5 4", "<p>5 x")}, "an index is not a number"),
        ({"drawn": faces("polygons", "v").replace("<p>5 4", "<p>5 99")}, "does not exist"),
        (
            {
                "drawn": faces("polygons", "v").replace(
                    "</polygons>", "<ph><p>0 1 2</p></ph></polygons>"
                )
            },
            "holes; export it with triangles",
        ),
    ],
)
def test_a_broken_file_gets_a_sentence(tmp_path, changes, problem):
    with pytest.raises(MeshFileError, match=problem):
        read_mesh_file(write(tmp_path / "l.dae", **changes))
