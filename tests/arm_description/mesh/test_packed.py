"""3MF files: the unit that they name."""

import zipfile

import numpy as np
import pytest
import trimesh

from arm_description.errors import MeshFileError
from arm_description.mesh.file import read_mesh_file

SIZE = (10.0, 20.0, 30.0)


def packed_box(path, unit):
    """Write a box as a file with the attribute `unit`, or without one."""
    box = trimesh.creation.box(SIZE)
    corners = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in box.vertices)
    faces = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in box.faces)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr(
            "3D/3dmodel.model",
            f"<model {unit} "
            'xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
            f'<object id="1" type="model"><mesh><vertices>{corners}</vertices>'
            f"<triangles>{faces}</triangles></mesh></object></resources>"
            '<build><item objectid="1"/></build></model>',
        )
    return path


@pytest.mark.parametrize(
    ("unit", "length"),
    [
        ("", 0.001),
        ('unit="micron"', 1e-6),
        ('unit="millimeter"', 0.001),
        ('unit="centimeter"', 0.01),
        ('unit="meter"', 1.0),
        ('unit="inch"', 0.0254),
        ('unit="foot"', 0.3048),
    ],
)
def test_lengths_are_in_the_unit_of_the_file_and_else_in_millimetres(tmp_path, unit, length):
    (part,) = read_mesh_file(packed_box(tmp_path / "box.3mf", unit))
    assert np.ptp(part.vertices, axis=0) == pytest.approx(np.multiply(SIZE, length))


def test_a_unit_that_the_format_does_not_know_is_named(tmp_path):
    with pytest.raises(MeshFileError, match="its unit 'parsec' is not one of micron, millimeter,"):
        read_mesh_file(packed_box(tmp_path / "box.3mf", 'unit="parsec"'))
