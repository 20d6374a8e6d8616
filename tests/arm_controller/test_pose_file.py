"""An invalid file is reported with its name and the line."""

from pathlib import Path

import pytest
from ament_index_python.packages import get_package_share_directory

from arm_controller.pose_file import PoseFileError, read_pose_file

JOINTS = ("j0", "j1")


@pytest.fixture
def poses_in(tmp_path):
    def read(text: str):
        path = tmp_path / "poses.yaml"
        path.write_text(text)
        return list(read_pose_file(path, JOINTS))

    return read


def test_reads_poses_in_order(poses_in):
    assert poses_in("poses:\n  - [1, 0.5]\n  - [-1e-3, .25]\n") == [(1.0, 0.5), (-0.001, 0.25)]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "must have the key 'poses'"),
        ("- [0, 0]\n", "must have the key 'poses'"),
        ("poses:\n", "line 1: 'poses' must be a list"),
        ("poses: []\n", "has no pose"),
        ("{}\n", "has no pose"),
        ("poses:\n  - [0, 0]\nspeed: 3\n", "line 3: unknown key 'speed'"),
        ("poses:\n  - 5\n", r"line 2: a pose is a list of 2 numbers, such as \[0.0, 0.0\]"),
        ("poses:\n  - [0, 0]\n  - [0]\n", "line 3: a pose is 2 numbers.*1 were given"),
        ("poses:\n  - [0, up]\n", "line 2: a pose is made of numbers; 'up' is not one"),
        ("poses:\n  - [0, true]\n", "'true' is not one"),
        ("poses:\n  - [0, '1']\n", "'1' is not one"),
        ("poses:\n  - [0, [1]]\n", "a list or mapping is not one"),
        ("poses:\n  - [0, nan]\n", "line 2: joint 'j1' cannot go to nan"),
        ("poses: [\n", "is not YAML: line 2"),
        ("poses: \x00\n", "is not YAML"),
    ],
)
def test_names_the_file_and_what_is_wrong(poses_in, text, message):
    with pytest.raises(PoseFileError, match=message) as caught:
        poses_in(text)
    assert "poses.yaml" in str(caught.value)


def test_names_a_missing_file():
    with pytest.raises(PoseFileError, match=r"the pose file /nowhere/poses\.yaml does not exist"):
        read_pose_file(Path("/nowhere/poses.yaml"), JOINTS)


def test_names_a_file_that_cannot_be_read(tmp_path):
    with pytest.raises(PoseFileError, match=f"cannot read the pose file {tmp_path}"):
        read_pose_file(tmp_path, JOINTS)


def test_the_defined_poses_are_the_five_of_the_original():
    file = Path(get_package_share_directory("arm_controller")) / "config/poses.yaml"
    assert read_pose_file(file, ("j0", "j1", "j2", "j3")) == (
        (0.5, 0.5, 0.5, 0.5),
        (0.7, 1.4, 0.5, 0.5),
        (0.5, 1.0, 0.6, 0.6),
        (0.3, 0.6, 0.3, 0.3),
        (0.0, 0.0, 0.0, 0.0),
    )
