"""The file that names the robots of one world."""

import pytest

from arm_gazebo.errors import SimSettingsError
from arm_gazebo.launching.controllers_file import controllers_in_namespace
from arm_gazebo.launching.several_robots import RobotRequest, read_robots_file


@pytest.fixture
def file(tmp_path):
    return tmp_path / "robots.yaml"


def test_robots_by_namespace_with_files_beside_the_file(file, tmp_path):
    file.write_text(
        "left: {model: arm.urdf, controllers: c.yaml, pose: [0, 1, 0, 0, 0, 1.5]}\n"
        "right: {model: /a/arm.urdf, model_args: 'prefix:=right_', base: free}\n"
        "third: {model: package://a/arm.urdf}\n"
    )
    robots = read_robots_file(file)
    assert robots["left"] == RobotRequest(
        model=str(tmp_path / "arm.urdf"),
        controllers=str(tmp_path / "c.yaml"),
        pose=(0.0, 1.0, 0.0, 0.0, 0.0, 1.5),
    )
    assert robots["right"] == RobotRequest("/a/arm.urdf", "prefix:=right_", base="free")
    assert robots["third"].model == "package://a/arm.urdf"


def test_lists_are_taken_as_the_arguments_of_the_launch_file(file):
    file.write_text(
        "left:\n"
        "  model: /a.urdf\n"
        "  spawn: [states, arm]\n"
        "  package_path: [/a, /b]\n"
        "  model_args: ['a:=1', 'b:=two words']\n"
    )
    request = read_robots_file(file)["left"]
    assert (request.spawn, request.package_path) == ("states,arm", "/a:/b")
    assert request.model_args == "a:=1 'b:=two words'"


def test_what_has_no_value_is_as_if_it_were_not_there(file):
    file.write_text("left: {model: /a.urdf, controllers: , spawn: , pose: , base: }")
    assert read_robots_file(file)["left"] == RobotRequest("/a.urdf")


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("", "names no robots"),
        ("- 1", "names no robots"),
        ("a: [", "is not YAML"),
        ("left: 1", "'left' has no model"),
        ("left: {}", "'left' has no model"),
        ("a/b: {model: x}", "'a/b': this is not a namespace"),
        (
            "left: {model: x, prefix: left_}",
            "prefix takes true or false, not 'left_'; true puts left_",
        ),
        ("left: {model: x, modelargs: y}", "has the key 'modelargs'; it takes model, model_args"),
        ("left: {model: x, pose: here}", "pose takes x y z roll pitch yaw, not 'here'"),
        ("left: {model: x, pose: [0, 1, 0]}", r"yaw, not \[0, 1, 0\]"),
        ("left: {model: x, pose: [0, 0, 0, 0, 0, .nan]}", "yaw, not .*nan"),
        ("left: {model: x, pose: '123456'}", "yaw, not '123456'"),
        ("left: {model: x, base: [free]}", r"base takes a text, not \['free'\]"),
    ],
)
def test_invalid_input_is_reported_in_a_sentence(file, content, sentence):
    file.write_text(content)
    with pytest.raises(SimSettingsError, match=sentence):
        read_robots_file(file)


def test_a_missing_file_is_named(file):
    sentence = f"cannot read the robots' file {file}: No such file or directory$"
    with pytest.raises(SimSettingsError, match=sentence):
        read_robots_file(file)


def test_nodes_of_a_controllers_file_go_below_the_namespace(tmp_path):
    path = tmp_path / "c.yaml"
    path.write_text(
        "controller_manager: {ros__parameters: {a: {type: x/Y}}}\n"
        "/elsewhere/a: {ros__parameters: {joints: [j]}}\n"
        "there: {a: {ros__parameters: {joints: [j]}}}\n"
        "/**: {a: {ros__parameters: {joints: [j]}}}\n"
    )
    assert list(controllers_in_namespace("left", path)) == [
        *("/left/controller_manager", "/elsewhere/a", "/there/a", "/left/**/a")
    ]
