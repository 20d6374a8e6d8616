"""How the steps of a plan wait for each other."""

import pytest

from launch_py import (
    ExecuteProcess,
    Finished,
    GroupAction,
    IncludeLaunchDescription,
    LaunchDescription,
    LogInfo,
    RegisterEventHandler,
    Shutdown,
    TimerAction,
)
from launch_py.conditions import IfCondition
from launch_py.errors import LaunchFileError
from launch_py.event_handlers import OnProcessExit, OnProcessStart
from launch_py.plan.steps import DeferredStep, MessageStep, ShutdownStep, Trigger, TriggerKind


def sh(name, **options):
    return ExecuteProcess(cmd=["true"], name=name, **options)


def waits(plan, name):
    (step,) = [step for step in plan.processes if step.name == name]
    return [(trigger.kind, trigger.process) for trigger in step.after]


def test_depends_on_an_action_or_a_name(expand):
    a = sh("a")
    plan = expand([a, sh("b", depends_on=a), sh("c", depends_on=["a", "b"])])
    assert waits(plan, "b") == [(TriggerKind.READY, "a")]
    assert waits(plan, "c") == [(TriggerKind.READY, "a"), (TriggerKind.READY, "b")]


def test_depends_on_a_later_action(expand):
    assert waits(expand([sh("b", depends_on="a"), sh("a")]), "b") == [(TriggerKind.READY, "a")]


def test_depends_on_all_processes_of_a_group_or_an_include(expand):
    group = GroupAction([sh("a"), sh("b")])
    include = IncludeLaunchDescription(LaunchDescription([sh("c")]))
    plan = expand([group, include, sh("d", depends_on=[group, include])])
    assert [process for _, process in waits(plan, "d")] == ["a", "b", "c"]


def test_an_unknown_process_suggests_a_similar_one(expand):
    with pytest.raises(LaunchFileError, match=r"b waits for unknown process 'sim1'.*mean 'sim'"):
        expand([sh("sim"), sh("b", depends_on="sim1")])


def test_an_action_that_is_not_in_the_description_is_refused(expand):
    with pytest.raises(LaunchFileError, match=r"b waits for .* not part of the launch description"):
        expand([sh("b", depends_on=sh("a"))])


@pytest.mark.parametrize("by_name", [True, False])
def test_a_dependency_that_is_switched_off_is_ignored(expand, by_name):
    a = sh("a", condition=IfCondition("false"))
    assert waits(expand([a, sh("b", depends_on="a" if by_name else a)]), "b") == []


def on_start(target, reaction):
    return RegisterEventHandler(OnProcessStart(target_action=target, on_start=reaction))


def on_exit(target, reaction):
    return RegisterEventHandler(OnProcessExit(target_action=target, on_exit=reaction))


@pytest.mark.parametrize("handler", [on_start, on_exit])
@pytest.mark.parametrize("by_name", [True, False])
def test_steps_that_wait_for_a_switched_off_process_are_left_out(expand, handler, by_name):
    a = sh("a", condition=IfCondition("false"))
    b = sh("b")
    plan = expand(
        [
            a,
            handler("a" if by_name else a, b),
            handler(a, lambda _event, _context: LogInfo(msg="x")),
            on_start(b, LogInfo(msg="x")),
            on_exit(b, LogInfo(msg="x")),
        ]
    )
    assert plan.steps == ()


def test_a_dependency_cycle_is_refused(expand):
    with pytest.raises(LaunchFileError, match="nothing can start first: a waits for b waits for a"):
        expand([sh("a", depends_on="b"), sh("b", depends_on="a")])


def test_event_handlers_add_triggers(expand):
    a = sh("a")
    plan = expand(
        [
            a,
            RegisterEventHandler(OnProcessStart(target_action=a, on_start=[sh("b")])),
            RegisterEventHandler(OnProcessExit(target_action="a", on_exit=sh("c"))),
        ]
    )
    assert waits(plan, "b") == [(TriggerKind.STARTED, "a")]
    assert waits(plan, "c") == [(TriggerKind.EXITED, "a")]


def test_event_handlers_nest(expand):
    a, b = sh("a"), sh("b")
    inner = RegisterEventHandler(OnProcessExit(target_action=b, on_exit=[sh("c")]))
    plan = expand(
        [
            a,
            RegisterEventHandler(
                OnProcessExit(
                    target_action=a, on_exit=[TimerAction(period=2.0, actions=[b]), inner]
                )
            ),
        ]
    )
    assert waits(plan, "b") == [(TriggerKind.EXITED, "a")]
    assert waits(plan, "c") == [(TriggerKind.EXITED, "a"), (TriggerKind.EXITED, "b")]
    assert [step.delay_s for step in plan.processes] == [0.0, 2.0, 0.0]


def test_on_exit_is_an_event_handler_of_the_process_itself(expand):
    plan = expand([sh("a", on_exit=[LogInfo(msg="gone"), Shutdown()])])
    after = (Trigger(TriggerKind.EXITED, "a"),)
    assert [type(step) for step in plan.steps[1:]] == [MessageStep, ShutdownStep]
    assert all(step.after == after for step in plan.steps[1:])


def test_a_function_as_handler_is_called_later(expand):
    a = sh("a")
    handler = OnProcessExit(target_action=a, on_exit=lambda _event, _context: [LogInfo(msg="x")])
    deferred = expand([a, RegisterEventHandler(handler)]).steps[1]
    assert isinstance(deferred, DeferredStep)
    (message,) = deferred.expand(None)
    assert isinstance(message, MessageStep)
    assert message.after == ()


def test_a_number_as_a_handler_s_target_is_refused():
    with pytest.raises(LaunchFileError, match=r"target_action= of OnProcessExit takes .*, not 3"):
        OnProcessExit(target_action=3, on_exit=[])  # pyright: ignore[reportArgumentType]


def test_start_up_leaves_out_reactions_and_keeps_what_follows_a_one_shot(expand):
    sim, spawner = sh("sim"), sh("spawner", ready=Finished())
    plan = expand(
        [
            sim,
            spawner,
            sh("second", depends_on=spawner),
            RegisterEventHandler(OnProcessExit(target_action=spawner, on_exit=sh("third"))),
            RegisterEventHandler(OnProcessExit(target_action=sim, on_exit=sh("mourner"))),
        ]
    )
    assert plan.start_up() == {"sim", "spawner", "second", "third"}
