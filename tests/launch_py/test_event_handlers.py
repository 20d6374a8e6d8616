"""Handlers of output and of the shutdown."""

import sys

import pytest

from launch_py import (
    LogInfo,
    LogLine,
    OpaqueFunction,
    RegisterEventHandler,
    RestartPolicy,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
)
from launch_py.command.listings import list_plan
from launch_py.conditions import IfCondition
from launch_py.errors import LaunchFileError
from launch_py.event_handlers import OnProcessIO, OnShutdown
from launch_py.substitutions import LaunchConfiguration
from launch_py.testing import fake_process


def on_io(**options):
    return RegisterEventHandler(OnProcessIO(**options))


def on_shutdown(reaction):
    return RegisterEventHandler(OnShutdown(on_shutdown=reaction))


def echo(event):
    return LogInfo(msg=f"heard {event.text.decode().strip()}")


# Lines


def test_a_function_gets_each_line(trial):
    events = []
    a = fake_process("a", restart=RestartPolicy.on_failure())
    t = trial(a, on_io(target_action=a, on_stdout=events.append, on_stderr=events.append))
    t["a"].write("one")
    t["a"].write("zwölf", "stderr")
    t["a"].end(1)
    t.advance(0.5)
    t["a"].write("again")
    assert [(e.process_name, e.pid, e.text) for e in events] == [
        ("a", 1001, b"one\n"),
        ("a", 1001, "zwölf\n".encode()),
        ("a", 1002, b"again\n"),
    ]
    assert [(e.from_stdout, e.from_stderr) for e in events[:2]] == [(True, False), (False, True)]


def test_each_stream_has_its_function(trial):
    t = trial(fake_process("a"), fake_process("b"), on_io(target_action="a", on_stderr=echo))
    t["a"].write("out")
    t["b"].write("other", "stderr")
    assert not any("heard" in line for line in t.screen.lines)
    t["a"].write("err", "stderr")
    assert t.screen.lines[-2:] == ["[a] err", "heard err"]


def test_each_line_may_start_processes(trial):
    t = trial(
        fake_process("a"), on_io(target_action="a", on_stdout=lambda _event: fake_process("b"))
    )
    t["a"].write("x")
    t["a"].write("x")
    assert t.started == ["a", "b", "b-2"]


def test_actions_after_a_line_may_wait_for_earlier_processes(trial):
    t = trial(
        fake_process("a"),
        fake_process("c", ready=LogLine("up")),
        on_io(target_action="a", on_stdout=lambda _event: fake_process("b", depends_on="c")),
    )
    t["a"].write("x")
    assert "b" not in t.started
    t["c"].write("up")
    assert t.started == ["a", "c", "b"]


def test_lines_are_handled_once_the_handler_is_registered(trial):
    t = trial(
        fake_process("a"),
        TimerAction(period=1.0, actions=[on_io(target_action="a", on_stdout=echo)]),
    )
    t["a"].write("early")
    t.advance(1.0)
    t["a"].write("late")
    assert [line for line in t.screen.lines if "heard" in line] == ["heard late"]


def test_lines_are_not_handled_during_the_shutdown(trial):
    t = trial(
        fake_process("a"),
        on_io(target_action="a", on_stdout=lambda _event: Shutdown(reason="enough")),
        on_io(target_action="a", on_stdout=echo),
    )
    t["a"].write("x")
    t["a"].write("y")
    assert "stopping: enough" in t.screen.lines
    assert not any("heard" in line for line in t.screen.lines)
    t["a"].end(0)
    assert t.finish() == 0


@pytest.mark.parametrize(
    ("mistake", "said"),
    [
        (lambda event: event.no_such_thing, "an event handler: AttributeError"),
        (lambda _event: sys.exit(3), "an event handler: SystemExit: 3"),
    ],
)
def test_a_function_that_fails_ends_the_launch_with_a_message(trial, mistake, said):
    t = trial(fake_process("a"), on_io(target_action="a", on_stdout=mistake))
    t["a"].write("x")
    assert t.asked_to_stop() == {"a"}
    t["a"].end(0)
    assert t.finish() == 1
    assert said in str(t.screen.last_line)


def test_a_handler_of_a_switched_off_process_does_nothing(trial):
    a = fake_process("a", condition=IfCondition("false"))
    t = trial(a, fake_process("b"), on_io(target_action=a, on_stdout=echo))
    t["b"].write("x")
    assert t.screen.lines[-1] == "[b] x"


def test_an_unknown_process_is_refused(expand):
    with pytest.raises(LaunchFileError, match="waits for unknown process 'b'; the processes are a"):
        expand([fake_process("a"), on_io(target_action="b", on_stdout=echo)])
    with pytest.raises(LaunchFileError, match=r"target_action= of OnProcessIO takes .*, not 3"):
        OnProcessIO(target_action=3, on_stdout=echo)  # pyright: ignore[reportArgumentType]


# Shutdown


def test_shutdown_handlers_run_before_any_process_is_stopped(trial):
    asked = []

    def farewell(event, _context):
        asked.append((event.reason, t.asked_to_stop()))
        return LogInfo(msg=f"bye: {event.reason}")

    t = trial(fake_process("a"), on_shutdown(farewell))
    assert asked == []
    t.supervisor.stop("SIGINT received")
    t.supervisor.stop("again")
    assert asked == [("SIGINT received", set())]
    assert t.asked_to_stop() == {"a"}
    assert "bye: SIGINT received" in t.screen.lines
    t["a"].end(0)
    assert t.finish() == 0


def test_actions_wait_for_the_shutdown(trial):
    called = []
    t = trial(
        fake_process("a"),
        SetLaunchConfiguration("who", "all"),
        on_shutdown(
            [
                OpaqueFunction(function=lambda _context: called.append("cleanup")),
                LogInfo(msg=["bye ", LaunchConfiguration("who")]),
            ]
        ),
    )
    assert called == []
    t["a"].end(0)
    assert called == []
    assert t.finish() == 0
    assert called == ["cleanup"]
    assert t.screen.lines[-1] == "bye all"


def test_shutdown_handlers_run_once_even_if_everything_ends_by_itself(trial):
    reasons = []
    t = trial(fake_process("a"), on_shutdown(lambda event, _context: reasons.append(event.reason)))
    t["a"].end(3)
    assert t.finish() == 3
    assert reasons == ["idle"]


def test_the_end_of_a_required_process_is_a_shutdown(trial):
    t = trial(fake_process("a", on_exit=Shutdown()), on_shutdown(LogInfo(msg="bye")))
    t["a"].end(3)
    assert "bye" in t.screen.lines
    assert t.finish() == 3


def test_a_handler_that_is_not_registered_yet_does_nothing(trial):
    t = trial(
        fake_process("a"), TimerAction(period=9.0, actions=[on_shutdown(LogInfo(msg="too early"))])
    )
    t.supervisor.stop("now")
    assert "too early" not in t.screen.lines


def test_nothing_is_started_during_the_shutdown(trial):
    t = trial(fake_process("a"), on_shutdown([fake_process("b"), LogInfo(msg="bye")]))
    t.supervisor.stop("now")
    assert t.started == ["a"]
    assert t.screen.problems == ["b is not started: the launch is stopping"]
    assert "bye" in t.screen.lines


def test_a_mistake_in_a_shutdown_handler_does_not_prevent_the_shutdown(trial):
    t = trial(
        fake_process("a"),
        on_shutdown(lambda event, _context: event.nothing),
        on_shutdown(LogInfo(msg="bye")),
    )
    t.supervisor.stop("now")
    assert "bye" in t.screen.lines
    assert t.asked_to_stop() == {"a"}
    t["a"].end(0)
    assert t.finish() == 1
    assert "an event handler: AttributeError" in str(t.screen.last_line)


def test_handlers_are_listed(expand):
    plan = expand([fake_process("a"), on_io(target_action="a"), on_shutdown(LogInfo(msg="bye"))])
    assert list_plan(plan, {}).count("actions that a function of the launch file decides") == 2


# Real processes


def test_real_lines_and_a_real_shutdown(launch):
    launched = launch(
        """
        talker = python("talker", "print('hello', flush=True); import signal; signal.pause()")
        actions = [
            talker,
            RegisterEventHandler(
                OnProcessIO(
                    target_action=talker,
                    on_stdout=lambda event: Shutdown(reason=f"heard {event.text!r}"),
                )
            ),
            RegisterEventHandler(
                OnShutdown(on_shutdown=lambda event, _: LogInfo(msg=f"farewell: {event.reason}"))
            ),
        ]
        """
    )
    assert launched.wait() == 0, launched.output
    assert "farewell: heard b'hello\\n'" in launched.output
