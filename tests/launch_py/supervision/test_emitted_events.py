"""Event handlers of any kind, the events that a file emits, and handlers that are taken back."""

import os
import signal

import pytest

from launch_py import (
    EmitEvent,
    ExecuteLocal,
    GroupAction,
    LogInfo,
    OpaqueCoroutine,
    RegisterEventHandler,
    UnregisterEventHandler,
)
from launch_py.errors import LaunchFileError
from launch_py.event_handlers import (
    EventHandler,
    OnActionEventBase,
    OnExecutionComplete,
    OnProcessExit,
    OnProcessIO,
    OnProcessStart,
    event_named,
)
from launch_py.events import (
    Event,
    IncludeLaunchDescription,
    ProcessExited,
    ProcessStarted,
    ShutdownProcess,
    SignalProcess,
    matches_action,
    matches_executable,
    matches_name,
    matches_pid,
)
from launch_py.launch_description import LaunchDescription
from launch_py.ros import LoadComposableNodes
from launch_py.testing import fake_process


class Custom(Event):
    """An event of a launch file's own."""

    name = "demo.Custom"

    def __init__(self, number: int) -> None:
        self.number = number


def log(text: str) -> LogInfo:
    return LogInfo(msg=text)


def test_a_handler_of_any_event_gets_those_that_its_matcher_takes(trial):
    a, b = fake_process("a"), fake_process("b")
    ended = EventHandler(
        matcher=lambda event: isinstance(event, ProcessExited) and event.returncode == 3,
        entities=lambda event, _context: log(f"{event.process_name} failed"),
    )
    named = EventHandler(
        matcher=event_named(ProcessStarted.name),
        entities=[log("one has started")],
        handle_once=True,
    )
    t = trial(a, b, RegisterEventHandler(ended), RegisterEventHandler(named))
    t["a"].end(0)
    t["b"].end(3)
    assert t.screen.lines.count("one has started") == 1
    assert t.screen.lines.count("b failed") == 1
    assert t.screen.lines.count("a failed") == 0


def test_an_event_of_the_file_s_own_class_is_handled(trial):
    handler = EventHandler(
        matcher=lambda event: isinstance(event, Custom),
        entities=lambda event, context: log(f"{event.number} {context.event is event}"),
    )
    a = fake_process("a")
    t = trial(
        RegisterEventHandler(handler),
        EmitEvent(event=Custom(1)),
        a,
        RegisterEventHandler(OnProcessExit(target_action=a, on_exit=EmitEvent(event=Custom(2)))),
    )
    assert (t.screen.lines.count("1 True"), t.screen.lines.count("2 True")) == (1, 0)
    t["a"].end()
    assert (t.screen.lines.count("1 True"), t.screen.lines.count("2 True")) == (1, 1)


def test_a_handler_that_is_unregistered_handles_nothing_more(trial):
    a, b = fake_process("a"), fake_process("b")
    on_b = OnProcessExit(target_action=b, on_exit=[log("b has ended")])
    t = trial(
        a,
        b,
        RegisterEventHandler(on_b),
        RegisterEventHandler(
            OnProcessExit(target_action=a, on_exit=[UnregisterEventHandler(on_b)])
        ),
    )
    t["a"].end()
    t["b"].end()
    assert t.screen.lines.count("b has ended") == 0


def test_a_handler_that_is_unregistered_too_late_handles_its_event(trial):
    a, b = fake_process("a"), fake_process("b")
    on_b = OnProcessExit(target_action=b, on_exit=[log("b has ended")])
    t = trial(
        a,
        b,
        RegisterEventHandler(on_b),
        RegisterEventHandler(
            OnProcessExit(target_action=a, on_exit=[UnregisterEventHandler(on_b)])
        ),
    )
    t["b"].end()
    assert t.screen.lines.count("b has ended") == 1
    registered = OnProcessStart(target_action=a, on_start=[])
    trial(a, RegisterEventHandler(registered))
    with pytest.raises(LaunchFileError, match="must exist before its handler is registered"):
        UnregisterEventHandler(registered)


def test_lines_are_handled_once_if_the_handler_says_so(trial):
    a = fake_process("a")
    once = OnProcessIO(target_action=a, on_stdout=lambda _: log("a line"), handle_once=True)
    t = trial(a, RegisterEventHandler(once))
    t["a"].write("one")
    t["a"].write("two")
    assert t.screen.lines.count("a line") == 1


def test_what_follows_the_completion_of_an_action(trial):
    a, group = fake_process("a"), GroupAction([log("in the group")])
    t = trial(
        RegisterEventHandler(
            OnExecutionComplete(
                target_action=a, on_completion=lambda event, _: log(f"done {event.action is a}")
            )
        ),
        RegisterEventHandler(
            OnExecutionComplete(target_action=group, on_completion=[log("after the group")])
        ),
        a,
        group,
    )
    assert (t.screen.lines.count("after the group"), t.screen.lines.count("done True")) == (1, 0)
    t["a"].end()
    assert t.screen.lines.count("done True") == 1


def test_the_base_of_handlers_of_an_action_s_events(trial):
    a, b = fake_process("a"), fake_process("b")
    t = trial(
        a,
        b,
        RegisterEventHandler(
            OnActionEventBase(
                action_matcher=a,
                on_event=[log("a has ended")],
                target_event_cls=ProcessExited,
                target_action_cls=type(a),
            )
        ),
    )
    t["b"].end()
    assert t.screen.lines.count("a has ended") == 0
    t["a"].end()
    assert t.screen.lines.count("a has ended") == 1


def test_an_emitted_event_stops_the_processes_that_it_is_for(trial):
    a, b = fake_process("a", respawn=True), fake_process("b")
    trigger = fake_process("trigger")
    stop = EmitEvent(event=ShutdownProcess(process_matcher=matches_action(a)))
    t = trial(
        a, b, trigger, RegisterEventHandler(OnProcessExit(target_action=trigger, on_exit=stop))
    )
    assert t["a"].stop_delays is None
    t["trigger"].end()
    assert t["a"].stop_delays is not None
    assert t["b"].stop_delays is None
    t["a"].end()
    assert t.runner.started.count("a") == 1


@pytest.mark.parametrize(
    ("matcher", "signalled"),
    [
        (matches_name("a"), ["a"]),
        (matches_pid(1002), ["b"]),
        (matches_executable("true"), ["a", "b"]),
        (lambda action: action.name == "b", ["b"]),
    ],
)
def test_an_emitted_event_sends_a_signal_by_its_name_or_number(trial, matcher, signalled):
    a, b = fake_process("a"), fake_process("b")
    t = trial(
        a,
        b,
        EmitEvent(event=SignalProcess(signal_number="SIGUSR1", process_matcher=matcher)),
        EmitEvent(event=SignalProcess(signal_number=signal.SIGHUP, process_matcher=matcher)),
    )
    both = [signal.SIGUSR1, signal.SIGHUP]
    assert {name: t[name].signals for name in "ab"} == {
        name: both if name in signalled else [] for name in "ab"
    }


def test_events_that_cannot_be_emitted_are_refused(trial):
    with pytest.raises(LaunchFileError, match="EmitEvent takes an event, not 'shutdown'"):
        EmitEvent(event="shutdown")  # pyright: ignore[reportArgumentType]
    with pytest.raises(LaunchFileError, match="there is no signal 'SIGNONE'"):
        trial(
            EmitEvent(event=SignalProcess(signal_number="SIGNONE", process_matcher=lambda _: True))
        )


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: RegisterEventHandler("x"), "RegisterEventHandler takes an event handler, not 'x'"),
        (lambda: UnregisterEventHandler("x"), "UnregisterEventHandler takes an event handler, not"),
        (lambda: ExecuteLocal(process_description="ls"), "takes an Executable, not 'ls'"),
        (
            lambda: LoadComposableNodes(composable_node_descriptions=["x"]),
            "LoadComposableNodes takes ComposableNodes, not 'x'",
        ),
    ],
)
def test_what_has_the_wrong_type_is_named(make, said):
    with pytest.raises(LaunchFileError) as caught:
        make()
    assert said in str(caught.value)


def test_an_emitted_description_is_included(trial):
    inner = LaunchDescription([log("included")])
    t = trial(fake_process("a"), EmitEvent(event=IncludeLaunchDescription(inner)))
    assert t.screen.lines.count("included") == 1


def test_a_coroutine_runs_beside_the_launch(trial, tmp_path):
    read_end, write_end = os.pipe()

    async def work(_context, word, *, last):
        os.write(write_end, f"{word} {last}".encode())

    trial(
        fake_process("a"),
        OpaqueCoroutine(coroutine=work, args=["first"], kwargs={"last": "second"}),
    )
    assert os.read(read_end, 100) == b"first second"
    os.close(read_end)
    os.close(write_end)
