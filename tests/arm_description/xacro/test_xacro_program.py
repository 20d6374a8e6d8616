"""xacro and its arguments in a launch file's Command: $(find) sees the user's own packages."""

import sys

import pytest

from arm_description.errors import XacroError
from arm_description.urdf.description_source import source_of
from arm_description.xacro.expansion import arguments_of_text, arguments_of_words
from arm_description.xacro.program import main
from launch_py import LaunchDescription, LogInfo
from launch_py.launch_description import expand_description
from launch_py.substitutions import Command, FindExecutable


@pytest.fixture
def file(tmp_path):
    """A xacro file in a package of the name of one of the suite's."""
    package = tmp_path / "arm_description"
    package.mkdir()
    (package / "package.xml").write_text("<package><name>arm_description</name></package>")
    file = package / "arm.xacro"
    file.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:arg name="a" default="1"/><link name="$(find arm_description)/$(arg a)"/></robot>'
    )
    return file


@pytest.mark.parametrize("program", ["xacro", FindExecutable(name="xacro")])
def test_a_command_finds_the_files_own_package(file, program):
    message = LogInfo(msg=Command([program, f" {file} a:=2"]))
    environ = {"PATH": "", "AMENT_PREFIX_PATH": sys.prefix}
    plan = expand_description(LaunchDescription([message]), {}, environ)
    [step] = plan.steps
    assert f'<link name="{file.parent}/2"/>' in str(step)


def test_the_description_contains_its_source(file, capsys):
    assert main([str(file)]) == 0
    assert source_of(capsys.readouterr().out).file == file


def test_a_failure_is_a_sentence(file, capsys):
    file.write_text(file.read_text().replace("$(arg a)", "${none}"))
    assert main([str(file)]) == 2
    assert capsys.readouterr().err == (
        f"cannot expand {file}, line 1: name 'none' is not defined\n"
    )


def test_what_xacro_does_besides_it_does(file, tmp_path, monkeypatch):
    words = ["xacro", str(file), "-o", str(tmp_path / "out.urdf")]
    monkeypatch.setattr(sys, "argv", words)
    assert main() == 0
    assert f'<link name="{file.parent}/1"/>' in (tmp_path / "out.urdf").read_text()


def test_arguments_are_words_of_name_and_value():
    words = ["a:=1", "b:=two words", "c:=", "d:=e:=f"]
    assert arguments_of_words(words) == {"a": "1", "b": "two words", "c": "", "d": "e:=f"}


def test_a_text_is_parted_as_in_a_shell():
    assert arguments_of_text("a:=1 b:='two words'\n") == {"a": "1", "b": "two words"}
    assert arguments_of_text("") == {}


@pytest.mark.parametrize("text", ["a", "a=1", ":=1", "a:='1"])
def test_a_word_that_is_not_an_argument_is_refused(text):
    with pytest.raises(XacroError, match=r"NAME:=VALUE|No closing quotation"):
        arguments_of_text(text)
