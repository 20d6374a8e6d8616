"""gz_sim.launch.py: what Gazebo's words come to, without starting anything."""

import os

import pytest
import yaml

from arm_cli.main import main
from launch_py.errors import LaunchError
from launch_py.launch_description import expand_description
from launch_py.launch_description_sources import read_launch_file
from launch_py.plan.steps import GeneratedFile, ProcessStep
from launch_py.system.packages import Packages


def simulation(gz_args: str) -> dict:
    """Return the parameters of the simulation."""
    file = Packages(os.environ).launch_file("ros_gz_sim", "gz_sim.launch.py")
    arguments = {"gz_args": gz_args}
    plan = expand_description(read_launch_file(file), arguments, dict(os.environ), file)
    (process,) = (
        step
        for step in plan.steps
        if isinstance(step, ProcessStep) and step.name == "arm_gazebo_node"
    )
    files = [yaml.safe_load(w.text) for w in process.command if isinstance(w, GeneratedFile)]
    (parameters,) = (f["/arm_gazebo"]["ros__parameters"] for f in files if "/arm_gazebo" in f)
    return parameters


@pytest.mark.parametrize(
    ("gz_args", "world"),
    [("shapes.sdf", "shapes"), ("-r -v 4 shapes.sdf", "shapes"), ("", "empty"), ("-r", "empty")],
)
def test_a_world_may_be_named_with_or_without_the_word_to_run(gz_args, world):
    assert simulation(gz_args)["world"] == world


def test_its_only_robot_is_a_camera():
    parameters = simulation("shapes.sdf")

    assert parameters["spawn"] == ""
    assert "<sensor" in parameters["robot_description"]


def test_a_word_that_means_nothing_is_refused():
    with pytest.raises(LaunchError, match="gz_args has '--gravity'; it takes"):
        simulation("--gravity shapes.sdf")


def test_the_arguments_of_the_simulation_are_its_own_too(capsys):
    line = ["launch", "ros_gz_sim", "gz_sim.launch.py", "gz_args:=-r house.world", "--print"]
    assert main([*line, "viewer:=true"]) == 0
    assert "\narm_viewer_node\n" in capsys.readouterr().out
