"""Actions that keep, bring back and clear settings, and substitutions for files and names."""

import os
import stat
from pathlib import Path

import pytest

from launch_py import (
    ExecuteLocal,
    GroupAction,
    LaunchDescription,
    LogInfo,
    PopEnvironment,
    PopLaunchConfigurations,
    PushEnvironment,
    PushLaunchConfigurations,
    ReplaceEnvironmentVariables,
    ResetEnvironment,
    ResetLaunchConfigurations,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    UnsetLaunchConfiguration,
)
from launch_py.action import Action
from launch_py.actions.execute_process import Executable
from launch_py.conditions import Condition
from launch_py.errors import LaunchFileError, SubstitutionError
from launch_py.launch_context import LaunchContext
from launch_py.launch_description import expand_description
from launch_py.plan.steps import MessageStep
from launch_py.ros import ExecutableInPackage, FindPackageShare, Node, Parameter, SetParameter
from launch_py.ros.actions import SetROSLogDir
from launch_py.ros.substitutions import Parameter as ParameterSubstitution
from launch_py.substitutions import (
    AnonName,
    BooleanSubstitution,
    EnvironmentVariable,
    FileContent,
    LaunchConfiguration,
    LaunchLogDir,
    PathJoinSubstitution,
    PathSubstitution,
    StringJoinSubstitution,
    ThisLaunchFileDir,
)
from launch_py.substitutions.files import MAX_CHARACTERS


def plan(*actions, environ=None):
    description = LaunchDescription(actions)
    return expand_description(description, {}, dict(os.environ) if environ is None else environ)


def said(*actions, environ=None) -> list[str]:
    steps = plan(*actions, environ=environ).steps
    return [step.text for step in steps if isinstance(step, MessageStep)]


def say(name: str) -> LogInfo:
    return LogInfo(msg=LaunchConfiguration(name, default="unset"))


def env(name: str) -> LogInfo:
    return LogInfo(msg=EnvironmentVariable(name, default_value="unset"))


def test_configurations_are_kept_and_brought_back():
    assert said(
        SetLaunchConfiguration("a", "1"),
        PushLaunchConfigurations(),
        SetLaunchConfiguration("a", "2"),
        PushLaunchConfigurations(),
        UnsetLaunchConfiguration("a"),
        say("a"),
        PopLaunchConfigurations(),
        say("a"),
        PopLaunchConfigurations(),
        say("a"),
    ) == ["unset", "2", "1"]
    with pytest.raises(LaunchFileError, match="PopLaunchConfigurations comes without Push"):
        plan(PopLaunchConfigurations())


def test_a_reset_leaves_the_given_configurations_which_it_performs_first():
    assert said(
        SetLaunchConfiguration("a", "1"),
        SetLaunchConfiguration("b", "2"),
        ResetLaunchConfigurations({"c": LaunchConfiguration("a")}),
        *map(say, "abc"),
        ResetLaunchConfigurations(),
        say("c"),
    ) == ["unset", "unset", "1", "unset"]


def test_environment_variables_are_kept_reset_and_replaced():
    assert said(
        SetEnvironmentVariable("A", "1"),
        PushEnvironment(),
        ReplaceEnvironmentVariables({"B": "2"}),
        *map(env, "ABC"),
        PopEnvironment(),
        *map(env, "ABC"),
        ResetEnvironment(),
        *map(env, "ABC"),
        environ={"C": "own"},
    ) == ["unset", "2", "unset", "1", "unset", "own", "unset", "unset", "own"]
    with pytest.raises(LaunchFileError, match="PopEnvironment comes without PushEnvironment"):
        plan(PopEnvironment())


def test_what_a_group_pushes_stays_in_it():
    with pytest.raises(LaunchFileError, match="without Push"):
        plan(GroupAction([PushLaunchConfigurations()]), PopLaunchConfigurations())


def test_a_process_by_its_description():
    described = Executable(
        cmd=["echo"], arguments=["a"], name="say", additional_env={"A": "1"}, cwd="/"
    )
    (step,) = plan(ExecuteLocal(process_description=described, respawn=True)).processes
    assert (step.name, step.command[1:], step.cwd) == ("say", ("a",), "/")
    assert (step.environment["A"], step.restart.when) == ("1", "always")


def test_an_action_of_the_file_s_own_takes_its_place_by_execute():
    class Twice(Action):
        def execute(self, context: LaunchContext):
            return [LogInfo(msg="one"), LogInfo(msg=LaunchConfiguration("two"))]

    assert said(SetLaunchConfiguration("two", "2"), Twice()) == ["one", "2"]


def test_a_condition_by_its_predicate():
    holds = Condition(predicate=lambda context: context.launch_configurations["a"] == "1")
    assert said(SetLaunchConfiguration("a", "1"), LogInfo(msg="yes", condition=holds)) == ["yes"]
    assert said(SetLaunchConfiguration("a", "2"), LogInfo(msg="yes", condition=holds)) == []


@pytest.fixture
def context(tmp_path):
    return LaunchContext(base_environment={"ROS_LOG_DIR": str(tmp_path)}).included(
        tmp_path / "a.launch.py"
    )


def test_files_and_names(context, tmp_path):
    (tmp_path / "text").write_text("a\nb\n")
    assert FileContent([ThisLaunchFileDir() / "text"]).perform(context) == "a\nb\n"
    with pytest.raises(SubstitutionError, match=f"cannot read {tmp_path}/none: No such file"):
        FileContent(tmp_path / "none").perform(context)
    with pytest.raises(SubstitutionError, match="/dev/null is not a regular file"):
        FileContent("/dev/null").perform(context)
    with pytest.raises(SubstitutionError, match="null"):
        FileContent("a\0b").perform(context)
    with (tmp_path / "text").open("wb") as file:
        file.truncate(MAX_CHARACTERS + 1)
    with pytest.raises(SubstitutionError, match=f"text has more than {MAX_CHARACTERS} characters"):
        FileContent(tmp_path / "text").perform(context)
    name = AnonName("node").perform(context)
    assert name.startswith(f"node_{os.getpid()}_")
    assert AnonName("node").perform(context.scoped()) == name
    assert AnonName("other").perform(context) != name
    assert LaunchLogDir().perform(context).startswith(f"{tmp_path}/20")
    assert (PathSubstitution("/a") / "b" / ["c", ".d"]).perform(context) == "/a/b/c.d"
    assert (PathJoinSubstitution(["/a", "b"]) / "c").perform(context) == "/a/b/c"
    assert StringJoinSubstitution([["a", "b"], "c"], delimiter="-").perform(context) == "ab-c"
    assert BooleanSubstitution("1").perform(context) == "true"


def test_the_log_folder_is_known_before_it_exists(context):
    from launch_py.screen.log_folder import LogFolder

    folder = LogFolder(Path(context.base_environment["ROS_LOG_DIR"]))
    assert str(folder.path) == LaunchLogDir().perform(context)
    folder.close()


def test_packages_their_executables_and_parameters(package_prefix, context):
    share = package_prefix("demo", "talker")
    context.base_environment = dict(os.environ)
    assert (FindPackageShare("demo") / "a").perform(context) == f"{share}/a"
    path = ExecutableInPackage("talker", "demo").perform(context)
    assert path.endswith("/lib/demo/talker")
    assert os.stat(path).st_mode & stat.S_IXUSR
    SetParameter("rate", 30).visit(context)
    assert ParameterSubstitution("rate").perform(context) == "30"
    assert ParameterSubstitution("rat", default="1").perform(context) == "1"
    with pytest.raises(SubstitutionError, match="no SetParameter sets 'rat' before its use; did"):
        ParameterSubstitution("rat").perform(context)
    (step,) = plan(
        SetROSLogDir("/tmp/log"),
        Node(
            package="demo",
            executable="talker",
            parameters=[Parameter("rate", "30", value_type=int), Parameter(["a", "b"], "c")],
        ),
    ).processes
    assert step.environment["ROS_LOG_DIR"] == "/tmp/log"
    assert '"rate": 30' in str(step.command)
    assert '"ab": "c"' in str(step.command)
