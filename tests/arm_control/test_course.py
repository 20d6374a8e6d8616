"""A course is a parameter file: defaults of launch arguments, controllers, sample nodes."""

import pytest

from arm_cli.main import main
from arm_control.course import COURSES, course_file, course_parameters, launch_arguments

POSES = {
    "S0": [1.0, 0.5, 0.1, 0.5],
    "S1": [1.0, 0.5, 0.0, 0.0],
    "S2": [0.4, -0.1, 0.5, 0.4],
    "S3": [-5.0, 0.5, -1.2, -1.0],
}
UPDATE_RATES = {"S0": 30, "S1": 100, "S2": 225, "S3": 100}


def test_every_file_is_a_course_and_every_course_has_one():
    assert {path.stem for path in course_file("S0").parent.glob("*.yaml")} == set(COURSES)


@pytest.mark.parametrize("course", COURSES)
def test_a_course_has_the_original_s_rate_and_pose(course):
    assert course_parameters(course, "controller_manager")["update_rate"] == UPDATE_RATES[course]
    assert course_parameters(course, "arm_controller_node")["desired_param"] == POSES[course]


@pytest.mark.parametrize("course", COURSES)
def test_launch_arguments_of_a_course_are_texts(course):
    arguments = launch_arguments(course)
    assert {type(value) for value in arguments.values()} == {str}
    assert arguments["controllers"] == arguments["params_file"] == str(course_file(course))


def test_no_course_changes_nothing():
    assert launch_arguments("none") == course_parameters("none", "arm_controller_node") == {}


@pytest.mark.parametrize("course", COURSES)
def test_a_course_starts_the_world_without_the_node(capsys, course):
    line = ["launch", "arm_gazebo", "arm_gazebo.launch.py", "--print"]
    assert main(line) == 0
    assert "\narm_controller_node\n" in capsys.readouterr().out
    assert main([*line, f"course:={course}"]) == 0
    assert "\narm_controller_node\n" not in capsys.readouterr().out


def test_what_the_user_gives_goes_before_the_course(capsys):
    line = ["launch", "arm_gazebo", "arm_gazebo.launch.py", "--print", "course:=S1"]
    assert main([*line, "controller_node:=true"]) == 0
    assert "\narm_controller_node\n" in capsys.readouterr().out
