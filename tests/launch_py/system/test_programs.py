"""Finding programs, and the errors for missing ones."""

import os

import pytest

from launch_py.errors import NotFoundError
from launch_py.system.programs import find_program


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
    ("name", "said"), [("slep", "; did you mean 'sleep'\\?$"), ("rozzz", "[^?]$")]
)
def test_a_missing_program_is_reported_with_a_hint(folder, name, said):
    with pytest.raises(NotFoundError, match=f"^no program '{name}' on PATH or in .*{said}"):
        find_program(name, str(folder))


def test_arm_stands_for_a_missing_ros2(folder):
    assert os.path.basename(find_program("ros2", str(folder))) == "arm"
    (folder / "ros2").touch(mode=0o755)
    assert find_program("ros2", str(folder)) == str(folder / "ros2")
