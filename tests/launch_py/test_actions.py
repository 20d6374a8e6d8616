"""The steps and settings that actions add."""

import os

import pytest

from launch_py import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    EmitEvent,
    ExecuteProcess,
    GroupAction,
    IncludeLaunchDescription,
    LaunchDescription,
    LogInfo,
    OpaqueFunction,
    ReadyPanel,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
    UnsetEnvironmentVariable,
)
from launch_py.conditions import IfCondition, UnlessCondition
from launch_py.errors import (
    LaunchError,
    LaunchFileError,
    NotFoundError,
    SubstitutionError,
    UsageError,
)
from launch_py.events import Shutdown as ShutdownEvent
from launch_py.launch_description import survey_description
from launch_py.plan.restart_policy import RestartHistory
from launch_py.plan.steps import MessageStep, ShutdownStep, StopDelays
from launch_py.substitutions import Call, LaunchConfiguration
from launch_py.testing import FakeClock


def sh(name="sh", **options):
    return ExecuteProcess(cmd=["sh", "-c", "true"], name=name, **options)


def texts(plan):
    return [step.text for step in plan.steps if isinstance(step, MessageStep)]


def test_the_default_is_used_if_no_value_is_given(expand):
    actions = [
        DeclareLaunchArgument("world", default_value="empty"),
        LogInfo(msg=LaunchConfiguration("world")),
    ]
    assert texts(expand(actions)) == ["empty"]
    assert texts(expand(actions, world="objects")) == ["objects"]


def test_a_required_argument_is_asked_for(expand):
    with pytest.raises(UsageError, match=r"'model' \(a URDF\) has no default: give model:=VALUE"):
        expand([DeclareLaunchArgument("model", description="a URDF")])


def test_a_value_outside_the_choices_lists_them_with_a_suggestion(expand):
    argument = DeclareLaunchArgument("camera", default_value="front", choices=["front", "side"])
    with pytest.raises(UsageError, match=r"cannot be 'frnt'; did you mean 'front'.*front, side"):
        expand([argument], camera="frnt")


def test_an_unknown_argument_suggests_a_similar_one(expand):
    plan = expand([DeclareLaunchArgument("world", default_value="empty")], wrld="x")
    (warning,) = plan.warnings
    assert warning.startswith("launch argument 'wrld' has no effect")
    assert warning.endswith("did you mean 'world'?")


def test_conditions_switch_actions_on_and_off(expand):
    actions = [
        DeclareLaunchArgument("headless", default_value="true"),
        LogInfo(msg="if", condition=IfCondition(LaunchConfiguration("headless"))),
        LogInfo(msg="unless", condition=UnlessCondition(LaunchConfiguration("headless"))),
    ]
    assert texts(expand(actions)) == ["if"]
    assert texts(expand(actions, headless="0")) == ["unless"]


def test_a_condition_that_is_not_a_boolean_is_refused(expand):
    with pytest.raises(SubstitutionError, match="needs true or false, not 'perhaps'"):
        expand([LogInfo(msg="x", condition=IfCondition("perhaps"))])


def test_a_group_s_settings_stay_inside(expand):
    actions = [
        SetLaunchConfiguration("a", "outside"),
        GroupAction([SetLaunchConfiguration("a", "inside"), LogInfo(msg=LaunchConfiguration("a"))]),
        LogInfo(msg=LaunchConfiguration("a")),
    ]
    assert texts(expand(actions)) == ["inside", "outside"]


def test_the_settings_of_a_group_without_scope_do_not(expand):
    actions = [
        GroupAction([SetLaunchConfiguration("a", "inside")], scoped=False),
        LogInfo(msg=LaunchConfiguration("a")),
    ]
    assert texts(expand(actions)) == ["inside"]


def test_a_group_without_forwarding_sees_no_outer_settings(expand):
    actions = [
        SetLaunchConfiguration("a", "outside"),
        SetEnvironmentVariable("NEW", "1"),
        GroupAction(
            [
                SetLaunchConfiguration("c", "inside"),
                LogInfo(msg=[LaunchConfiguration(n, default="none") for n in "abc"]),
                sh("in"),
            ],
            forwarding=False,
            launch_configurations={"b": LaunchConfiguration("a")},
        ),
        LogInfo(msg=LaunchConfiguration("a")),
        GroupAction([LogInfo(msg=LaunchConfiguration("a"))], scoped=False, forwarding=False),
    ]
    plan = expand(actions)
    assert texts(plan) == ["noneoutsideinside", "outside", "outside"]
    assert plan.processes[0].environment == {}


def test_a_timer_that_outlives_the_shutdown_is_refused(expand):
    assert texts(expand([TimerAction(period=0.0, actions=[], cancel_on_shutdown="true")])) == []
    with pytest.raises(LaunchFileError, match="TimerAction's cancel_on_shutdown cannot be false"):
        expand([TimerAction(period=0.0, actions=[], cancel_on_shutdown=False)])


def test_arguments_of_ros_without_effect_are_accepted(expand):
    (step,) = expand([sh(log_cmd=True, cached_output=True)]).processes
    assert step == expand([sh()]).processes[0]


def test_the_environment_is_that_of_the_scope(expand):
    environ = {**os.environ, "LIST": "b", "GONE": "1"}
    plan = expand(
        [
            sh("before"),
            SetEnvironmentVariable("NEW", "1"),
            UnsetEnvironmentVariable("GONE"),
            AppendEnvironmentVariable("LIST", "c", separator=":"),
            AppendEnvironmentVariable("LIST", "a", prepend=True, separator=":"),
            GroupAction([SetEnvironmentVariable("NEW", "2")]),
            sh("after", additional_env={"OWN": "x"}),
        ],
        environ=environ,
    )
    before, after = plan.processes
    assert before.environment == {}
    assert after.environment == {"NEW": "1", "GONE": None, "LIST": "a:b:c", "OWN": "x"}


def test_env_replaces_everything(expand):
    (step,) = expand([SetEnvironmentVariable("A", "1"), sh(env={"B": "2"})]).processes
    assert step.replace_environment
    assert step.environment == {"B": "2"}


def test_an_opaque_function_adds_actions(expand):
    def decide(context, word):
        return [LogInfo(msg=word + context.launch_configurations["a"])]

    actions = [SetLaunchConfiguration("a", "1"), OpaqueFunction(function=decide, args=["x"])]
    assert texts(expand(actions)) == ["x1"]


def test_an_opaque_function_may_return_nothing(expand):
    assert expand([OpaqueFunction(function=lambda _: None)]).steps == ()


def test_a_timer_delays_and_adds_up(expand):
    plan = expand([TimerAction(period=1.5, actions=[TimerAction(period="2", actions=[sh()])])])
    assert plan.processes[0].delay_s == 3.5


def test_shutdown_and_its_event_mean_the_same(expand):
    plan = expand([Shutdown(reason="a"), EmitEvent(event=ShutdownEvent(reason="b"))])
    assert [s.reason for s in plan.steps if isinstance(s, ShutdownStep)] == ["a", "b"]


def test_a_ready_panel_is_performed(expand):
    plan = expand(
        [
            SetLaunchConfiguration("t", "/joint_states"),
            ReadyPanel(title="arm", topics=[(LaunchConfiguration("t"), "states")]),
            ReadyPanel(commands={"move": "arm topic pub"}),
        ]
    )
    first, second = plan.panels
    assert (first.title, first.topics) == ("arm", (("/joint_states", "states"),))
    assert second.commands == (("move", "arm topic pub"),)


def test_an_entry_that_is_not_an_action_is_refused():
    with pytest.raises(LaunchFileError, match="takes actions, not 'x' of type str"):
        LaunchDescription(["x"])  # pyright: ignore[reportArgumentType]


def test_a_missing_program_suggests_similar_names_before_anything_starts(expand):
    with pytest.raises(NotFoundError, match=r"no program 'slep' on PATH.*did you mean 'sleep'"):
        expand([ExecuteProcess(cmd=["slep", "1"])])


def test_a_shell_line_is_left_to_the_shell(expand):
    (step,) = expand([ExecuteProcess(cmd=["echo a |", "cat"], shell=True)]).processes
    assert step.command == ("/bin/sh", "-c", "echo a | cat")


def test_a_prefix_is_put_before_the_command(expand):
    (step,) = expand([sh(prefix="env -i")]).processes
    assert [os.path.basename(str(word)) for word in step.command[:3]] == ["env", "-i", "sh"]


@pytest.mark.parametrize("prefix", [None, "", " "])
def test_an_empty_prefix_adds_nothing(expand, prefix):
    assert len(expand([sh(prefix=prefix)]).processes[0].command) == 3


@pytest.mark.parametrize(
    ("action", "message"),
    [
        (
            LogInfo(msg="x", condition=LaunchConfiguration("x")),  # pyright: ignore[reportArgumentType]
            r"^condition= takes an IfCondition\(\.\.\.\), not .*LaunchConfiguration",
        ),
        (sh(additional_env=[("A", "b")]), r"^env= and additional_env= take a dict, not \[\("),
        (sh(env="A=b"), "^env= and additional_env= take a dict, not 'A=b'"),
        (sh(prefix='"'), "^an ExecuteProcess of sh: ValueError: No closing quotation"),
        (sh(cwd=3), "a text or a substitution is needed, not 3"),
        (sh(ready=["up"]), "^an ExecuteProcess of sh: AttributeError"),
        (GroupAction([sh(env={"A": 1})]), "needed, not 1 of type int"),
        (sh(output=3), "needed, not 3 of type int"),
        (
            IncludeLaunchDescription(LaunchDescription(), launch_arguments=["abc"]),  # pyright: ignore[reportArgumentType]
            "^launch_arguments= takes pairs of two texts, not 'abc'$",
        ),
    ],
)
def test_invalid_arguments_of_an_action_are_reported(expand, action, message):
    with pytest.raises(LaunchError, match=message):
        expand([action])


def test_a_dependency_on_something_else_is_refused():
    with pytest.raises(LaunchFileError, match="depends_on= takes actions and names, not 3"):
        sh(depends_on=[3])


def test_choices_may_be_numbers(expand):
    argument = DeclareLaunchArgument("n", choices=[1, 2])
    assert expand([argument], n="2").steps == ()
    with pytest.raises(UsageError, match="'n' cannot be '3'; the choices are 1, 2"):
        expand([argument], n="3")


def test_names_are_made_unique(expand):
    plan = expand([sh("a"), sh("a"), ExecuteProcess(cmd=["true"])])
    assert [step.name for step in plan.processes] == ["a", "a-2", "true"]


def test_respawn_is_a_restart_policy(expand):
    (step,) = expand([sh(respawn=True, respawn_delay=2.0, respawn_max_retries=3)]).processes
    policy = step.restart
    assert (policy.when, policy.first_delay_s, policy.factor) == ("always", 2.0, 1.0)
    assert policy.max_restarts == 3


def test_all_requested_retries_are_made(expand):
    (step,) = expand([sh(respawn=True, respawn_max_retries=10)]).processes
    history = RestartHistory(step.restart, FakeClock())
    assert [history.ended(1).delay_s for _ in range(11)] == [0.0] * 10 + [None]


def test_retries_without_a_number_end_with_a_crash_loop(expand):
    (step,) = expand([sh(respawn=True)]).processes
    history = RestartHistory(step.restart, FakeClock())
    assert [history.ended(1).delay_s for _ in range(5)] == [0.0] * 4 + [None]


def test_stop_delays_may_be_substitutions(expand):
    (step,) = expand([sh(sigterm_timeout="1.5", sigkill_timeout=2)]).processes
    assert step.stop_delays == StopDelays(1.5, 2.0)


@pytest.mark.parametrize("value", ["soon", -1, "-0.5", "nan"])
@pytest.mark.parametrize(
    ("action", "name"),
    [
        (lambda value: sh(sigterm_timeout=value), "sigterm_timeout"),
        (lambda value: sh(sigkill_timeout=value), "sigkill_timeout"),
        (lambda value: TimerAction(period=value, actions=[]), "TimerAction's period"),
    ],
)
def test_a_duration_that_is_not_a_number_is_refused(expand, action, name, value):
    with pytest.raises(LaunchFileError, match=f"^{name} is .*, not a number of seconds$"):
        expand([action(value)])


def test_a_restart_policy_is_asked_for():
    with pytest.raises(LaunchFileError, match="restart= takes a RestartPolicy, not 'always'"):
        sh(restart="always")


def test_an_unknown_event_is_refused():
    with pytest.raises(LaunchFileError, match=r"EmitEvent takes an event, not 'stop'"):
        EmitEvent(event="stop")  # pyright: ignore[reportArgumentType]


@pytest.mark.parametrize("cmd", [[], "", [""]])
def test_a_command_is_asked_for(expand, cmd):
    with pytest.raises(LaunchFileError, match=r"ExecuteProcess needs cmd=\[program"):
        expand([ExecuteProcess(cmd=cmd)])


def test_unknown_output_is_refused(expand):
    with pytest.raises(LaunchFileError, match="output='scren' of sh; did you mean 'screen'"):
        expand([sh(output="scren")])


@pytest.mark.parametrize(
    ("output", "shown"),
    [
        ({"both": "log"}, ""),
        ({"both": "screen"}, "stderr stdout"),
        ({"stdout": "log", "stderr": "screen"}, "stderr"),
        ({"stdout": {"screen", "own_log"}, "stderr": ["log"]}, "stdout"),
        ({"stdout": "screen"}, "stdout"),
        ({"both": "log", "stdout": LaunchConfiguration("where", default="full")}, "stdout"),
        ({}, ""),
        ("log", "stderr"),
        (["scr", "een"], "stderr stdout"),
    ],
)
def test_output_may_be_given_for_each_stream(expand, output, shown):
    (step,) = expand([sh(output=output)]).processes
    assert " ".join(sorted(step.shown)) == shown


@pytest.mark.parametrize(
    ("output", "message"),
    [
        ({"sdtout": "log"}, "the key 'sdtout' in output= of sh; did you mean 'stdout'"),
        ({"both": "nowhere"}, "both: 'nowhere' in output= of sh; the choices are both, full, log"),
        ({"stderr": ["log", "scren"]}, "stderr: 'scren' in output= of sh; did you mean 'screen'"),
        ({"both": {"stdout": "log"}}, "both: {.*} in output= of sh: a word is needed, not a dict"),
        ({"both": 3}, "needed, not 3 of type int"),
        ({1: "log"}, "needed, not 1 of type int"),
    ],
)
def test_invalid_output_is_reported(expand, output, message):
    with pytest.raises(LaunchFileError, match=message):
        expand([sh(output=output)])


@pytest.mark.parametrize(
    ("action", "message"),
    [
        (sh(respawn="maybe"), "respawn of sh is 'maybe', neither true nor false"),
        (sh(emulate_tty="maybe"), "emulate_tty of sh is 'maybe', neither true nor false"),
        (
            AppendEnvironmentVariable("LIST", "a", prepend="maybe"),
            "AppendEnvironmentVariable's prepend is 'maybe', neither true nor false",
        ),
    ],
)
def test_a_value_that_is_not_a_boolean_is_reported(expand, action, message):
    with pytest.raises(LaunchFileError, match=message):
        expand([action])


def test_booleans_may_be_substitutions(expand):
    (step,) = expand([sh(respawn=["fal", "se"], emulate_tty="True")]).processes
    assert step.restart.when == "never"
    assert step.emulate_tty


def test_an_error_in_an_opaque_function_is_reported(expand):
    def decide(_context):
        return {}["missing"]

    with pytest.raises(LaunchFileError, match="OpaqueFunction decide: KeyError: 'missing'"):
        expand([OpaqueFunction(function=decide)])


def test_a_survey_does_not_perform_costly_substitutions(expand):
    calls = []

    def describe():
        calls.append(1)
        return "text"

    argument = DeclareLaunchArgument("description", default_value=Call(describe))
    survey = survey_description(LaunchDescription([argument]), {})
    assert survey.arguments["description"].default == "Call(describe)"
    assert calls == []
    expand([argument])
    assert calls == [1]


def test_a_default_that_is_no_text_is_refused_by_the_launch_and_shown_by_a_survey(expand):
    argument = DeclareLaunchArgument("rate", default_value=1)  # pyright: ignore[reportArgumentType]
    survey = survey_description(LaunchDescription([argument]), {})
    assert survey.arguments["rate"].default == "1"
    with pytest.raises(LaunchFileError, match="a text or a substitution is needed, not 1 of type"):
        expand([argument])
