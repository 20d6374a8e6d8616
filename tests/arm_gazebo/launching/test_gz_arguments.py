"""Gazebo's options translated to launch arguments."""

import pytest

from arm_gazebo.errors import SimSettingsError
from arm_gazebo.launching.gz_arguments import launch_arguments


@pytest.mark.parametrize(
    ("gz_args", "meant"),
    [
        ("", {}),
        ("-r", {}),
        ("-r -v 1 empty.sdf", {"log_level": "error", "world": "empty"}),
        ("-r -v 4 objects.sdf", {"log_level": "info", "world": "objects"}),
        ("-v2 -r -s objects", {"log_level": "warn", "headless": "true", "world": "objects"}),
        ("-r --headless-rendering lab.xml", {"world": "lab.xml"}),
        ("-r 'my worlds/lab.xml'", {"world": "my worlds/lab.xml"}),
        ("objects.sdf", {"world": "objects", "paused": "true"}),
    ],
)
def test_words_stand_for_launch_arguments(gz_args, meant):
    assert launch_arguments(gz_args) == meant


def test_an_existing_file_keeps_its_suffix(tmp_path):
    file = tmp_path / "lab.world"
    file.touch()
    assert launch_arguments(f"-r {file}") == {"world": str(file)}


@pytest.mark.parametrize(
    ("gz_args", "said"),
    [
        ("-r -g", "'-g'; it takes -r, -s"),
        ("-r -v", "-v ''; it takes 0 to 4"),
        ("-r -v 7", "-v '7'; it takes 0 to 4"),
        ("-r empty.sdf objects.sdf", "two worlds, 'empty' and 'objects.sdf'"),
        ("-r 'lab", "no closing quotation"),
    ],
)
def test_what_means_nothing_here_is_refused(gz_args, said):
    with pytest.raises(SimSettingsError, match=said):
        launch_arguments(gz_args)
