"""Programs that are found, and what is said of others."""

import pytest

from launch_py.errors import NotFoundError
from launch_py.programs import find_program


@pytest.fixture
def folder(tmp_path):
    for name in ("sleep", "groups", "rosidl"):
        (tmp_path / name).touch(mode=0o755)
    return tmp_path


def test_a_program_is_found_by_name_or_path(folder):
    path = str(folder / "sleep")
    assert find_program("sleep", str(folder)) == path
    assert find_program(path, "") == path


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("slep", "; did you mean 'sleep'\\?$"),
        ("ros2", "; arm has the same verbs, as in: arm control list_controllers$"),
        ("rozzz", "[^?]$"),
    ],
)
def test_a_missing_program_has_a_hint_where_there_is_one(folder, name, said):
    with pytest.raises(NotFoundError, match=f"^no program '{name}' on PATH or in .*{said}"):
        find_program(name, str(folder))
