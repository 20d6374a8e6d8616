"""Launch files of ROS 2 import launch_py's names, but only while they are read."""

import importlib
import os
import re
import sys
import textwrap
from pathlib import Path

import pytest
from run_python import run_python

import launch_py
from launch_py.errors import LaunchFileError
from launch_py.launch_description import expand_description
from launch_py.launch_description_sources import read_launch_file
from launch_py.plan.steps import MessageStep
from launch_py.ros_imports import HOMES, NOT_HERE, OTHER_NAMES, MissingRosNameError, ros_imports

TYPED = """
import os
import launch
import launch_ros.actions
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    ExecuteProcess,
    IncludeLaunchDescription,
    OpaqueFunction,
    RegisterEventHandler,
)
from launch.conditions import IfCondition
from launch.event_handlers import OnProcessExit
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch.actions.log_info import LogInfo
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def setup(context, *args, **kwargs):
    from launch.utilities import perform_substitutions

    who = perform_substitutions(context, [LaunchConfiguration("who")])
    return [launch.actions.LogInfo(msg=f"hello {who}")]


def generate_launch_description():
    share = get_package_share_directory("demo")
    talker = Node(package="demo", executable="talker", name="talker", output="screen",
                  parameters=[{"rate": LaunchConfiguration("rate")}])
    return LaunchDescription([
        DeclareLaunchArgument(name="rate", default_value="10", description="in Hz"),
        DeclareLaunchArgument("who", default_value="arm"),
        talker,
        launch_ros.actions.Node(package="demo", executable="listener",
                                condition=IfCondition("false")),
        RegisterEventHandler(event_handler=OnProcessExit(
            target_action=talker, on_exit=[LogInfo(msg=os.path.basename(share))])),
        OpaqueFunction(function=setup),
    ])
"""


@pytest.fixture
def ros_file(tmp_path):
    def write(text: str, name: str = "typed.launch.py"):
        path = tmp_path / name
        path.write_text(textwrap.dedent(text))
        return path

    return write


def expand(path, **arguments: str):
    return expand_description(read_launch_file(path), arguments, dict(os.environ), path)


def test_a_launch_file_of_ros_runs_unchanged(ros_file, package_prefix):
    package_prefix("demo", "talker", "listener")
    plan = expand(ros_file(TYPED), rate="30")
    assert [step.name for step in plan.processes] == ["talker"]
    assert '"rate": 30' in str(plan.processes[0].command)
    texts = [step.text for step in plan.steps if isinstance(step, MessageStep)]
    assert texts == ["demo", "hello arm"]


def test_the_names_exist_only_while_a_file_is_read(ros_file, package_prefix):
    package_prefix("demo", "talker", "listener")
    hooks = list(sys.meta_path)
    expand(ros_file(TYPED))
    assert sys.meta_path == hooks
    assert not [name for name in sys.modules if name.partition(".")[0] in ("launch", "launch_ros")]


def test_a_file_that_fails_leaves_no_modules_behind(ros_file):
    hooks = list(sys.meta_path)
    with pytest.raises(LaunchFileError, match="ZeroDivisionError"):
        read_launch_file(ros_file("import launch.actions\n1 / 0\n"))
    assert sys.meta_path == hooks
    assert "launch.actions" not in sys.modules


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            "from launch.actions import ExecuteProces",
            "launch.actions has no 'ExecuteProces' here; did you mean 'ExecuteProcess'",
        ),
        (
            "from launch import LaunchService\nLaunchService()",
            "launch has no 'LaunchService' here; `arm launch FILE` runs the description",
        ),
        (
            "from launch.conditions import Zebra",
            "launch.conditions has no 'Zebra' here; it has Condition, IfCondition, ",
        ),
        ("import launch\nlaunch.Nothing", "launch has no 'Nothing' here; it has Action, "),
        ("import launch_ros.zebra.other", "there is no module 'launch_ros.zebra' here; "),
    ],
)
def test_a_missing_name_is_reported(ros_file, line, said):
    path = ros_file(line)
    number = len(line.splitlines())
    with pytest.raises(LaunchFileError) as caught:
        read_launch_file(path)
    assert str(caught.value).startswith(f"{path}, line {number}: {said}")


def test_every_name_of_the_table_exists():
    with ros_imports():
        for name in HOMES:
            module = __import__(name, fromlist=["*"])
            assert module.__all__
            assert [n for n in module.__all__ if getattr(module, n, None) is None] == []
            assert NOT_HERE.get(name, {}).keys().isdisjoint(OTHER_NAMES.get(name, {}))
        from launch import LaunchDescription  # pyright: ignore[reportMissingImports]

        assert LaunchDescription is launch_py.LaunchDescription
    assert set(OTHER_NAMES) <= set(HOMES)


def test_an_installed_launch_takes_precedence(tmp_path, ros_file):
    package = tmp_path / "site" / "launch"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("class LaunchDescription: ...\n")
    path = ros_file(
        """
        from launch import LaunchDescription
        def generate_launch_description():
            return LaunchDescription()
        """
    )
    code = (
        f"from launch_py.launch_description_sources import *; read_launch_file(Path({str(path)!r}))"
    )
    done = run_python("-c", code, env={**os.environ, "PYTHONPATH": str(package.parent)})
    assert "imports the `launch` of an installed ROS 2: start it with `ros2 launch`" in done.stderr


def test_a_folder_named_launch_is_not_an_installed_launch(tmp_path, ros_file):
    (tmp_path / "site" / "launch").mkdir(parents=True)
    path = ros_file("from launch import LaunchDescription as D\ngenerate_launch_description = D\n")
    code = (
        f"from launch_py.launch_description_sources import *; read_launch_file(Path({str(path)!r}))"
    )
    done = run_python("-c", code, env={**os.environ, "PYTHONPATH": str(tmp_path / "site")})
    assert (done.returncode, done.stderr) == (0, "")


def test_ros2_in_a_command_is_arm(ros_file, monkeypatch):
    monkeypatch.setenv("PATH", "/bin")
    plan = expand(
        ros_file(
            """
            from launch import LaunchDescription
            from launch.actions import ExecuteProcess
            from launch.substitutions import FindExecutable

            def generate_launch_description():
                return LaunchDescription([
                    ExecuteProcess(cmd=["ros2", "control", "load_controller", "x"]),
                    ExecuteProcess(cmd=["ros2 topic list"], shell=True),
                    ExecuteProcess(cmd=[[FindExecutable(name="ros2"), " topic list"]], shell=True),
                    ExecuteProcess(cmd=["cd / && ls"], shell=True),
                ])
            """
        )
    )
    first, second, third, fourth = (step.command for step in plan.processes)
    arm = first[0]
    assert os.path.basename(str(arm)) == "arm"
    assert first[1:] == ("control", "load_controller", "x")
    assert second[2] == third[2] == f"{arm} topic list"
    assert fourth[2] == "cd / && ls"


PAGE = Path(__file__).parents[2] / "docs" / "reference" / "launch_names.md"
ROW = re.compile(r"\| `(\w+)` \| (works|differs|not here) \| (.*) \|")
DUPLICATES = ("launch.launch_introspector", "launch.launch_service")
"""Modules whose only name is in another module, too."""


def listed() -> list[tuple[str, str, str, str]]:
    """Return module, name, state and remark of each row."""
    found, module = [], ""
    for line in PAGE.read_text().splitlines():
        if line.startswith("## "):
            module = line[3:]
        elif match := ROW.fullmatch(line):
            found.append((module, *match.groups()))
    return found


@pytest.mark.parametrize("module", sorted({row[0] for row in listed()}))
def test_every_name_of_a_module_can_be_imported(module):
    with ros_imports():
        home = importlib.import_module(module)
        for _, name, state, remark in (row for row in listed() if row[0] == module):
            value = getattr(home, name)
            assert value is not None
            assert (state == "not here") == (NOT_HERE.get(module, {}).get(name) == remark)
            if state == "not here":
                sentence = f"{module} has no '{name}' here; {re.escape(remark)}"
                for use in (lambda v=value: v(), lambda v=value: v.level, lambda v=value: v("a")):
                    with pytest.raises(MissingRosNameError, match=sentence):
                        use()


def test_the_page_has_all_that_is_not_here_and_counts_right():
    rows = listed()
    absent = {(module, name) for module, name, state, _ in rows if state == "not here"}
    assert absent == {
        (module, name)
        for module, names in NOT_HERE.items()
        for name in names
        if module not in DUPLICATES
    }
    states = [state for _, _, state, _ in rows]
    works, differs, lacks = (states.count(state) for state in ("works", "differs", "not here"))
    text = " ".join(PAGE.read_text().split())
    assert f"all {len(rows)} names: {works} work, {differs} differ as" in text
    assert f"and {lacks} can be imported" in text
    assert all(remark for _, _, state, remark in rows if state != "works")


def test_a_setting_of_what_is_not_here_is_an_error():
    with ros_imports():
        import launch  # pyright: ignore[reportMissingImports]

        with pytest.raises(MissingRosNameError, match="launch_config' here; set ROS_LOG_DIR"):
            launch.logging.launch_config.level = 10
