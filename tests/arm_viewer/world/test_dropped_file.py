"""Files that are dropped on the page: what `arm check` says decides."""

import struct

import pytest

from arm_viewer.errors import DroppedFileError
from arm_viewer.world.dropped_file import MAX_BYTES, DroppedFile, check_file, check_size

CORNERS = ((0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1))
FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))


def tetrahedron() -> bytes:
    """Return a binary STL."""
    faces = [struct.pack("<12fH", 0, 0, 0, *sum((CORNERS[i] for i in f), ()), 0) for f in FACES]
    return bytes(80) + struct.pack("<I", len(faces)) + b"".join(faces)


def test_a_mesh_becomes_a_thing_that_the_simulation_takes(tmp_path):
    checked = check_file(DroppedFile("my part.STL", tetrahedron(), 0.001), tmp_path)
    assert checked.name == "my_part"
    assert "<scale>0.001 0.001 0.001</scale>" in checked.text
    assert "1 of them free to move" in checked.report
    assert str(tmp_path) not in checked.report


def test_what_cannot_be_simulated_is_refused_in_the_words_of_the_check(tmp_path):
    with pytest.raises(DroppedFileError, match=r"(?s)x\.urdf cannot be simulated.*not XML"):
        check_file(DroppedFile("x.urdf", b"<robot name='x'><link name='a'></robot>"), tmp_path)


@pytest.mark.parametrize(
    ("name", "data", "sentence"),
    [
        ("a.exe", b"MZ", "is not a URDF, SDF or STL file"),
        ("../../a", b"x", "is not a URDF, SDF or STL file"),
        ("a.stl", b"", "has 0 bytes"),
        ("a.sdf", b"\xff\xfe", "is not text in UTF-8"),
        ("a.urdf", b"<robot><xacro:include filename='/etc/passwd'/></robot>", "is a program"),
    ],
)
def test_a_file_of_another_kind_is_not_even_checked(name, data, sentence, tmp_path):
    with pytest.raises(DroppedFileError, match=sentence):
        check_file(DroppedFile(name, data), tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_too_large_a_file_is_refused_by_its_size():
    with pytest.raises(DroppedFileError, match="16,000,001 bytes"):
        check_size("a.stl", MAX_BYTES + 1)
