"""Included launch files: their scope, their arguments and their errors."""

import os

import pytest

from launch_py.command.command_line import find_launch_file
from launch_py.errors import LaunchError, LaunchFileError, NotFoundError
from launch_py.launch_description import survey_description
from launch_py.launch_description_sources import read_launch_file
from launch_py.plan.steps import MessageStep

CHILD = """
actions = [
    DeclareLaunchArgument("world", default_value="empty", description="what to load"),
    DeclareLaunchArgument("rate", default_value="100"),
    SetLaunchConfiguration("mine", "child"),
    LogInfo(msg=["child ", LaunchConfiguration("world"), " ", LaunchConfiguration("rate")]),
]
"""
INCLUDE = 'IncludeLaunchDescription([ThisLaunchFileDir(), "/child.launch.py"]'


def texts(plan):
    return [step.text for step in plan.steps if isinstance(step, MessageStep)]


@pytest.fixture
def parent(write_launch_file):
    write_launch_file(CHILD, "child.launch.py")

    def write(arguments: str = "", before: str = "", after: str = ""):
        return write_launch_file(f"actions = [{before}{INCLUDE}{arguments}),{after}]")

    return write


def test_arguments_are_passed(parent, expand_file):
    path = parent(', launch_arguments={"world": "objects"}.items()')
    assert texts(expand_file(path)) == ["child objects 100"]


def test_the_command_line_reaches_an_argument_that_only_the_included_file_declares(
    parent, expand_file
):
    assert texts(expand_file(parent(), rate="500")) == ["child empty 500"]


def test_an_argument_that_the_include_sets_has_no_effect_on_the_command_line(parent, expand_file):
    plan = expand_file(parent(', launch_arguments={"world": "objects"}'), world="empty")
    assert texts(plan) == ["child objects 100"]
    assert "launch argument 'world' has no effect: nothing that starts reads it" in plan.warnings[0]


def test_an_argument_that_is_read_but_not_declared_is_taken(write_launch_file, expand_file):
    child = """actions = [
        LogInfo(msg=["child ", LaunchConfiguration("speed", default="1")]),
        OpaqueFunction(function=lambda context: [
            LogInfo(msg=context.launch_configurations.get("colour", "grey")),
        ]),
    ]"""
    write_launch_file(child, "child.launch.py")
    path = write_launch_file(
        f"""actions = [
        {INCLUDE}, launch_arguments={{"colour": "red"}}),
        LogInfo(msg=LaunchConfiguration("mode", default="slow")),
    ]"""
    )
    plan = expand_file(path, speed="3", mode="fast")
    assert texts(plan) == ["child 3", "red", "fast"]
    assert plan.warnings == ()


@pytest.mark.parametrize(
    "reader",
    [
        "dict(context.launch_configurations)",
        "{**context.launch_configurations}",
        "list(context.launch_configurations.items())",
        "context.launch_configurations['any']",
        "'any' in context.launch_configurations",
    ],
)
def test_a_function_may_read_an_argument_in_any_way(write_launch_file, expand_file, reader):
    path = write_launch_file(
        f"actions = [OpaqueFunction(function=lambda context: [LogInfo(msg=str({reader}))])]"
    )
    assert expand_file(path, any="7").warnings == ()


def test_an_included_file_sees_the_outer_configurations(parent, expand_file):
    path = parent(before='SetLaunchConfiguration("world", "outer"), ')
    assert texts(expand_file(path)) == ["child outer 100"]


def test_nothing_leaks_out(parent, expand_file):
    path = parent(after=' LogInfo(msg=LaunchConfiguration("mine", default="clean")),')
    assert texts(expand_file(path)) == ["child empty 100", "clean"]


def test_an_argument_that_it_does_not_read_is_a_warning(parent, expand_file):
    path = parent(', launch_arguments={"wrld": "objects"}')
    (warning,) = expand_file(path).warnings
    assert "child.launch.py: launch argument 'wrld' has no effect" in warning
    assert "did you mean 'world'" in warning


def test_a_declared_argument_of_a_part_that_does_not_start_is_no_warning(parent, expand_file):
    plan = expand_file(parent(', condition=IfCondition("false")'), world="objects")
    assert plan.warnings == ()


def test_the_survey_lists_the_included_arguments_with_their_file(parent):
    path = parent(before='DeclareLaunchArgument("top", default_value="1"), ')
    arguments = survey_description(read_launch_file(path), {}, path).arguments
    assert list(arguments) == ["top", "world", "rate"]
    assert arguments["world"].description == "what to load"
    assert arguments["world"].launch_file is not None
    assert arguments["world"].launch_file.name == "child.launch.py"


def test_a_conditional_include_is_surveyed_but_not_expanded(parent, expand_file):
    path = parent(', condition=IfCondition("false")')
    assert texts(expand_file(path, world="objects")) == []


def test_a_cycle_of_includes_is_reported(write_launch_file, expand_file):
    path = write_launch_file("actions = [IncludeLaunchDescription(ThisLaunchFile())]")
    with pytest.raises(LaunchFileError, match="include each other in a cycle"):
        expand_file(path)


def test_a_file_named_relatively_knows_its_folder(
    parent, write_launch_file, expand_file, monkeypatch
):
    top = parent()
    monkeypatch.chdir(top.parent)
    outer = write_launch_file(
        f'actions = [IncludeLaunchDescription("{top.name}")]', "outer.launch.py"
    )
    assert texts(expand_file(outer)) == ["child empty 100"]
    assert expand_file(find_launch_file([top.name], {})).steps


@pytest.mark.parametrize(
    "arguments", ["zip(['world'], ['objects'])", "(p for p in [('world', 'objects')])"]
)
def test_arguments_from_an_iterator_are_passed(parent, expand_file, arguments):
    assert texts(expand_file(parent(f", launch_arguments={arguments}"))) == ["child objects 100"]


def test_no_arguments_may_be_none(parent, expand_file):
    assert texts(expand_file(parent(", launch_arguments=None"))) == ["child empty 100"]


def test_one_source_included_twice_is_two_copies(write_launch_file, expand_file):
    write_launch_file(
        "a = forever('a'); actions = [a, forever('b', depends_on=a)]", "robot.launch.py"
    )
    path = write_launch_file(
        """
        source = PythonLaunchDescriptionSource([ThisLaunchFileDir(), "/robot.launch.py"])
        actions = [IncludeLaunchDescription(source), IncludeLaunchDescription(source)]
        """
    )
    plan = expand_file(path)
    waits_for = {s.name: [trigger.process for trigger in s.after] for s in plan.processes}
    assert waits_for == {"a": [], "b": ["a"], "a-2": [], "b-2": ["a-2"]}


def test_a_fifo_is_not_a_launch_file(tmp_path):
    os.mkfifo(tmp_path / "a.launch.py")
    with pytest.raises(NotFoundError, match=r"a\.launch\.py is not a regular file, so it is not a"):
        read_launch_file(tmp_path / "a.launch.py")


def test_a_missing_file_is_reported_with_similar_files(parent, write_launch_file, expand_file):
    parent()
    path = write_launch_file(f"actions = [{INCLUDE.replace('child', 'chld')})]")
    with pytest.raises(NotFoundError, match=r"no launch file .*did you mean 'child.launch.py'"):
        expand_file(path)


def test_a_script_is_not_offered_as_a_launch_file(tmp_path):
    (tmp_path / "move.py").touch()
    with pytest.raises(NotFoundError, match=rf"no launch file .*; {tmp_path} holds none$"):
        read_launch_file(tmp_path / "zzz.launch.py")


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("x = ", "line 1: SyntaxError"),
        ("1 / 0", "line 1: ZeroDivisionError: division by zero"),
        ("x = 1", r"does not define generate_launch_description\(\)"),
        ("import sys\nsys.exit(0)", r"line 2: SystemExit: 0"),
        ("def generate_launch_description():\n  raise SystemExit(0)", r"line 2: SystemExit: 0"),
        ("def generate_launch_description():\n    return 3", "returns int, not LaunchDescription"),
        ("def generate_launch_description():\n    return 1 / 0", "line 2: ZeroDivisionError"),
    ],
)
def test_a_broken_launch_file_is_reported_with_its_line(tmp_path, body, message):
    path = tmp_path / "broken.launch.py"
    path.write_text(body)
    with pytest.raises(LaunchFileError, match=message):
        read_launch_file(path)


def test_other_formats_of_launch_files_are_refused(tmp_path):
    path = tmp_path / "launch.lua"
    path.touch()
    with pytest.raises(LaunchFileError, match=r"does not end like a launch file: .py, .xml"):
        read_launch_file(path)


def test_reading_leaves_no_cache_folder(write_launch_file):
    path = write_launch_file("actions = []")
    read_launch_file(path)
    assert [p.name for p in path.parent.iterdir() if p.name != "log"] == [path.name]


@pytest.mark.parametrize(
    ("action", "said"),
    [
        ("EqualsSubstitution(LaunchConfiguration('a'), 1)", "no launch argument 'a'"),
        ("NotSubstitution('maybe')", "maybe is 'maybe', neither"),
        ("PythonExpression('1 / 0')", "expression '1 / 0' raises ZeroDivisionError"),
        ("33", "a text or a substitution is needed, not 33"),
    ],
)
def test_errors_of_expansion_name_file_and_line(write_launch_file, expand_file, action, said):
    path = write_launch_file(f"actions = [\nLogInfo(msg='a'),\nLogInfo(msg={action}),\n]")
    with pytest.raises(LaunchError) as caught:
        expand_file(path)
    line = next(n for n, text in enumerate(path.read_text().splitlines(), 1) if action in text)
    assert str(caught.value).startswith(f"{path}, line {line}: {said}")
