"""Handlers of every process, and the content of events."""

import re

import pytest

from launch_py import ExecuteProcess, LogInfo, RegisterEventHandler, RestartPolicy, Shutdown
from launch_py.conditions import IfCondition
from launch_py.errors import SubstitutionError
from launch_py.event_handlers import OnProcessExit, OnProcessIO, OnProcessStart, OnShutdown
from launch_py.substitutions import LocalSubstitution
from launch_py.testing import fake_process


def on_io(**options):
    return RegisterEventHandler(OnProcessIO(**options))


def on_shutdown(reaction):
    return RegisterEventHandler(OnShutdown(on_shutdown=reaction))


# Handlers of every process


def test_without_a_target_every_process_is_handled_including_later_ones(trial):
    heard = []
    t = trial(
        RegisterEventHandler(
            OnProcessStart(on_start=lambda event, _: heard.append(f"{event.process_name} up"))
        ),
        RegisterEventHandler(
            OnProcessExit(on_exit=lambda event, _: heard.append(f"{event.process_name} over"))
        ),
        on_io(on_stdout=lambda event: heard.append(f"{event.process_name} wrote")),
        fake_process("a", restart=RestartPolicy("on-failure", max_restarts=1)),
        fake_process("b", on_exit=lambda *_: fake_process("c")),
        fake_process("off", condition=IfCondition("false")),
    )
    assert heard == ["a up", "b up"]
    t["a"].end(1)
    t.advance(0.5)
    t["b"].end(0)
    assert heard[2:] == ["b over", "c up"]
    t["c"].write("x")
    t["c"].end(0)
    t["a"].end(0)
    assert heard[4:] == ["c wrote", "c over", "a over"]
    assert t.finish() == 0


def test_a_function_may_select_the_processes(trial):
    heard = []
    a, b = fake_process("a"), fake_process("b")
    t = trial(
        a,
        b,
        on_io(
            target_action=lambda action: action == b,
            on_stdout=lambda event: heard.append(event.text),
        ),
        RegisterEventHandler(
            OnProcessExit(
                target_action=lambda action: action == b,
                on_exit=[LogInfo(msg="b"), fake_process("c")],
            )
        ),
    )
    t["a"].write("a")
    t["b"].write("b")
    t["a"].end(0)
    assert "b" not in t.screen.lines
    t["b"].end(0)
    assert "b" in t.screen.lines
    assert heard == [b"b\n"]
    assert t.started == ["a", "b", "c"]


def test_a_handler_of_every_exit_runs_during_the_shutdown(trial):
    heard = []
    t = trial(
        fake_process("a", on_exit=Shutdown()),
        fake_process("b"),
        RegisterEventHandler(OnProcessExit(on_exit=lambda event, _: heard.append(event.pid))),
    )
    t["a"].end(0)
    t["b"].end(0)
    t.settle()
    assert heard == [1001, 1002]


def test_actions_for_every_process_run_for_each(trial):
    t = trial(
        fake_process("a"),
        fake_process("b"),
        RegisterEventHandler(OnProcessExit(on_exit=[LogInfo(msg="one over")])),
    )
    t["a"].end(0)
    t["b"].end(0)
    assert t.screen.lines.count("one over") == 2


# The content of events


def test_events_describe_their_process(trial):
    events = []
    a = ExecuteProcess(cmd=["true", "x"], name="a", cwd="/tmp")
    t = trial(
        a,
        fake_process("b"),
        RegisterEventHandler(
            OnProcessStart(target_action=a, on_start=lambda event, _: events.append(event))
        ),
        on_io(target_action=a, on_stdout=events.append),
        RegisterEventHandler(
            OnProcessExit(target_action=a, on_exit=lambda event, _: events.append(event))
        ),
    )
    t["a"].write("one")
    t["a"].end(3)
    assert [type(event).__name__ for event in events] == [
        *("ProcessStarted", "ProcessStdout", "ProcessExited")
    ]
    assert all(event.action == a and event.process_name == "a" for event in events)
    assert {(event.cmd[1:], event.cwd, event.pid) for event in events} == {(("x",), "/tmp", 1001)}
    assert all(event.env == {"FAKE": "1"} for event in events)
    assert events[-1].returncode == 3


def test_an_event_of_a_failed_start_has_no_process(trial):
    events = []
    a = fake_process("a", on_exit=lambda event, _: events.append(event))
    t = trial(a, cannot_start=["a"])
    t.settle()
    (event,) = events
    assert (event.action, event.pid, event.env, event.returncode) == (a, 0, {}, 127)


def test_actions_may_use_the_event(trial):
    code = LogInfo(msg=["code ", LocalSubstitution("event.returncode")])
    t = trial(
        fake_process("a", on_exit=lambda *_: code),
        on_shutdown(LogInfo(msg=["bye: ", LocalSubstitution("event.reason", "why")])),
    )
    t["a"].end(3)
    assert "code 3" in t.screen.lines
    assert t.finish() == 3
    assert t.screen.lines[-1] == "bye: idle"


@pytest.mark.parametrize(
    ("expression", "said"),
    [
        ("event.reasn", "no 'reasn' in Shutdown"),
        ("reason", r"LocalSubstitution\('reason'\) has no value: only event.NAME has one"),
    ],
)
def test_a_missing_attribute_of_an_event_is_reported(trial, expression, said):
    t = trial(fake_process("a"), on_shutdown(LogInfo(msg=LocalSubstitution(expression))))
    t["a"].end(0)
    assert t.finish() == 1
    assert re.search(said, str(t.screen.last_line))


def test_a_handler_s_list_does_not_use_the_outer_event(trial):
    inner = fake_process("b", on_exit=LogInfo(msg=LocalSubstitution("event.pid")))
    t = trial(fake_process("a", on_exit=lambda *_: inner))
    t["a"].end(0)
    assert t.finish() == 1
    assert "has no value before the event" in str(t.screen.last_line)


def test_before_the_event_its_attributes_have_no_value(expand):
    code = LogInfo(msg=LocalSubstitution("event.returncode"))
    with pytest.raises(SubstitutionError, match="has no value before the event; give the handler"):
        expand([fake_process("a", on_exit=code)])


# Real processes


def test_events_of_real_processes(launch):
    launched = launch(
        """
        def tell(event, context):
            print("TOLD", event.action is a, event.cmd[3:], event.env["OWN"], "PATH" in event.env)

        a = python("a", "print('hello')", additional_env={"OWN": "x"}, on_exit=tell)
        a.cmd.append("last")
        actions = [a]
        """
    )
    assert launched.wait() == 0, launched.output
    assert "TOLD True ('last',) x True" in launched.lines
