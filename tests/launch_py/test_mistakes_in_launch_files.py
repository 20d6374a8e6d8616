"""Mistakes in launch files: each is told in a sentence that names the file and what exists."""

import pytest

from launch_py.errors import LaunchFileError
from launch_py.launch_description import expand_description
from launch_py.launch_description_sources import read_launch_file


@pytest.mark.parametrize(
    ("action", "sentence"),
    [
        ("Node(executable='a', on_exti=1)", "Node takes no argument 'on_exti'; did you mean"),
        (
            "LifecycleNode(name='n', executable='a', namspace='b')",
            "LifecycleNode takes no argument 'namspace'; did you mean 'namespace'",
        ),
        ("Node(executable='a', arguments=5)", "arguments= takes a list, not 5 of type int"),
        ("ExecuteProcess(cmd=5)", "cmd= takes a list, not 5 of type int"),
        ("DeclareLaunchArgument('a', choices=5)", "choices= takes a list, not 5 of type int"),
        (
            "ResetLaunchConfigurations(5)",
            "ResetLaunchConfigurations takes a dict, not 5 of type int",
        ),
        (
            "ReplaceEnvironmentVariables(['a'])",
            "ReplaceEnvironmentVariables takes a dict, not ['a'] of type list",
        ),
        ("GroupAction(5)", "GroupAction takes actions, not 5 of type int"),
        ("GroupAction([], launch_configurations=5)", "launch_configurations= takes a dict, not 5"),
        ("IncludeLaunchDescription('a', launch_arguments=5)", "a dict or pairs are needed, not 5"),
        ("SetLaunchConfiguration(3, 4)", "a text or a substitution is needed, not 3 of type int"),
    ],
)
def test_an_argument_of_the_wrong_kind_names_the_action_and_the_line(
    action, sentence, write_launch_file, expand_file
):
    path = write_launch_file(f"from launch_py.ros import LifecycleNode\nactions = [{action}]")
    with pytest.raises(LaunchFileError) as error:
        expand_file(path)
    assert f"{path}, line " in str(error.value)
    assert sentence in str(error.value)


def test_a_handler_of_an_unknown_process_names_those_that_exist(write_launch_file, expand_file):
    path = write_launch_file(
        "actions = [ExecuteProcess(cmd=['true'], name='a'), RegisterEventHandler("
        "OnProcessExit(target_action='x', on_exit=[LogInfo(msg='over')]))]"
    )
    with pytest.raises(LaunchFileError, match="waits for unknown process 'x'; the processes are a"):
        expand_file(path)


def test_a_module_that_ros_does_not_have_is_not_taken_for_one(tmp_path):
    path = tmp_path / "test.launch.py"
    path.write_text("from launch.nope import Nothing\n")
    with pytest.raises(LaunchFileError, match=r"line 1: there is no module 'launch\.nope' here"):
        read_launch_file(path)


def test_a_missing_module_of_moveit_says_what_there_is_instead(tmp_path):
    path = tmp_path / "test.launch.py"
    path.write_text("from moveit_configs_utils import MoveItConfigsBuilder\n")
    with pytest.raises(
        LaunchFileError, match=r"line 1: .*moveit_configs_utils'; there is no MoveIt"
    ):
        read_launch_file(path)


@pytest.mark.parametrize("text", ["launch:\n- [a, b]: {x: 1}\n", "launch:\n- node: {[a, b]: 1}\n"])
def test_a_list_as_a_name_in_yaml_is_told(text, tmp_path):
    path = tmp_path / "test.launch.yaml"
    path.write_text(text)
    with pytest.raises(LaunchFileError, match="yaml, line 2: a name must stand before the colon"):
        read_launch_file(path)


def test_an_xml_file_that_is_not_utf_8_is_told(tmp_path):
    path = tmp_path / "test.launch.xml"
    path.write_bytes("<launch><arg name='caf\xe9'/></launch>".encode("latin-1"))
    with pytest.raises(LaunchFileError, match="is not UTF-8, as the byte 0xe9 tells"):
        read_launch_file(path)


def test_a_python_file_may_declare_its_encoding(tmp_path):
    text = (
        "# -*- coding: latin-1 -*-\n"
        "from launch_py import LaunchDescription, LogInfo\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([LogInfo(msg='caf\xe9')])\n"
    )
    path = tmp_path / "test.launch.py"
    path.write_bytes(text.encode("latin-1"))
    plan = expand_description(read_launch_file(path), {}, {}, path)
    assert [step.text for step in plan.steps] == ["caf\xe9"]
    path.write_bytes(text.partition("\n")[2].encode("latin-1"))
    with pytest.raises(LaunchFileError, match=r"test.launch.py.*codec can't decode byte 0xe9"):
        read_launch_file(path)
