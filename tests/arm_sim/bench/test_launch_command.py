"""The command line of the launch that a test asks for."""

import sys

import pytest

from arm_sim.bench.processes import launch_command
from arm_sim.errors import BenchError

ARM = [sys.executable, "-P", "-m", "arm_cli", "launch"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({}, []),
        ({"robot": "arm", "world": "objects"}, ["world:=objects"]),
        ({"robot": "mycobot"}, ["mycobot"]),
        (
            {"robot": "my.urdf", "controllers": "c.yaml"},
            ["arm_gazebo", "sim.launch.py", "controllers:=c.yaml", "model:=my.urdf"],
        ),
        ({"launch": "my.launch.py"}, ["my.launch.py"]),
        ({"launch": ("pkg", "my.launch.py")}, ["pkg", "my.launch.py"]),
        ({"arguments": {"paused": True, "rate": 2}}, ["paused:=true", "rate:=2"]),
    ],
)
def test_the_command(arguments, words):
    assert launch_command(**arguments) == [*ARM, *words]


def test_a_robot_and_a_launch_file_exclude_each_other():
    with pytest.raises(BenchError, match="name a robot or a launch file, not both"):
        launch_command(robot="arm", launch="my.launch.py")


def test_the_run_of_a_robot_is_recorded(tmp_path):
    file = tmp_path / "there" / "test.run"
    assert launch_command(robot="mycobot", record_to=file)[-1] == f"record_run:={file}"
    assert file.parent.is_dir()
    assert launch_command(launch="my.launch.py", record_to=file) == [*ARM, "my.launch.py"]
