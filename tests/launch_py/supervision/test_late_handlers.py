"""Exit handlers and shutdown handlers during the shutdown."""

import signal
import textwrap
import threading

import pytest

from launch_py import (
    LogInfo,
    OpaqueFunction,
    RegisterEventHandler,
    RestartPolicy,
    Shutdown,
    TimerAction,
)
from launch_py.event_handlers import OnProcessExit, OnShutdown
from launch_py.supervision.event_handling import HANDLER_TIMEOUT_S
from launch_py.testing import fake_process


def on_exit(target, reaction):
    return RegisterEventHandler(OnProcessExit(target_action=target, on_exit=reaction))


def test_exit_handlers_run_during_the_shutdown(trial):
    events = []
    t = trial(
        fake_process("a", on_exit=Shutdown()),
        fake_process("b", on_exit=[LogInfo(msg="b is over")]),
        on_exit("b", lambda event, _context: events.append((event.process_name, event.returncode))),
    )
    t["a"].end(0)
    t["b"].end(130)
    t.settle()
    assert "b is over" in t.screen.lines
    assert events == [("b", 130)]
    assert t.finish() == 0


def test_the_exit_that_triggers_the_shutdown_still_has_its_other_handlers(trial):
    a = fake_process("a", on_exit=Shutdown())
    t = trial(a, on_exit(a, lambda event, _context: LogInfo(msg=f"verdict {event.returncode}")))
    t["a"].end(3)
    t.settle()
    assert "verdict 3" in t.screen.lines
    assert t.finish() == 3


def test_exit_handlers_start_nothing_and_wait_for_no_timer_during_the_shutdown(trial):
    t = trial(
        fake_process(
            "a", on_exit=[fake_process("b"), TimerAction(period=1.0, actions=[LogInfo(msg="no")])]
        ),
        on_exit("a", lambda *_: [fake_process("c"), LogInfo(msg="said"), Shutdown()]),
        on_exit("b", LogInfo(msg="b has no end")),
        on_exit("a", OpaqueFunction(function=lambda _context: LogInfo(msg="asked"))),
    )
    t.supervisor.stop("test")
    t["a"].end(0)
    t.settle()
    assert t.started == ["a"]
    assert t.screen.problems == [f"{name} is not started: the launch is stopping" for name in "bc"]
    assert [line for line in t.screen.lines if line in ("said", "asked", "no")] == ["said", "asked"]
    assert "b has no end" not in t.screen.lines
    assert t.finish() == 0


def test_steps_that_are_not_due_before_the_shutdown_are_left_out(trial):
    t = trial(fake_process("a"), LogInfo(msg="later"), cannot_start=["a"])
    assert t.finish() == 127
    assert "later" not in t.screen.lines


@pytest.mark.parametrize("mistake", [lambda: {}["missing"], lambda: exit(7)])
def test_a_mistake_in_a_handler_is_reported_and_changes_nothing_else(trial, mistake):
    t = trial(
        fake_process("a"),
        fake_process("b"),
        on_exit("a", lambda *_: mistake()),
        on_exit("b", lambda *_: LogInfo(msg="b is over")),
    )
    t.supervisor.stop("test")
    t["a"].end(0)
    t["b"].end(0)
    t.settle()
    assert ["an event handler: " in line for line in t.screen.problems] == [True]
    assert "b is over" in t.screen.lines
    assert t.finish() == 0


def test_a_function_that_does_not_return_delays_no_stop_and_is_abandoned(trial):
    never = threading.Event()
    t = trial(
        fake_process("a"),
        fake_process("b", depends_on="a"),
        on_exit("b", lambda *_: never.wait()),
        on_exit("a", lambda *_: LogInfo(msg="never asked")),
    )
    t.supervisor.stop("test")
    t["b"].end(0)
    assert t.asked_to_stop() == {"a", "b"}
    t["a"].end(0)
    assert not t.supervisor.done
    t.advance(HANDLER_TIMEOUT_S)
    assert "an event handler has not returned after 5 s" in t.screen.problems[-1]
    assert t.finish() == 0
    never.set()


def test_a_forced_stop_waits_for_no_function(trial):
    never = threading.Event()
    t = trial(fake_process("a"), fake_process("b"), on_exit("a", lambda *_: never.wait()))
    t.supervisor.stop("first")
    t["a"].end(0)
    t.supervisor.kill("second")
    assert t.finish() == 130
    never.set()


# Shutdown handlers


def on_shutdown(reaction):
    return RegisterEventHandler(OnShutdown(on_shutdown=reaction))


def test_processes_stop_after_all_shutdown_handlers_and_are_not_restarted_before(trial):
    may_go_on = threading.Event()
    again = RestartPolicy("always", first_delay_s=1.0)
    t = trial(
        fake_process("a"),
        fake_process("b", restart=again),
        fake_process("c", restart=again),
        on_shutdown(lambda *_: may_go_on.wait() and None),
        on_shutdown(LogInfo(msg="bye")),
    )
    t["b"].end(0)
    t.supervisor.stop("test")
    t["c"].end(0)
    t.advance(2.0)
    assert t.asked_to_stop() == set()
    assert "bye" not in t.screen.lines
    may_go_on.set()
    t.loop.run(until=t.asked_to_stop)
    assert "bye" in t.screen.lines
    assert t.asked_to_stop() == {"a"}
    t["a"].end(0)
    assert t.started == ["a", "b", "c"]
    assert t.finish() == 0


def test_a_shutdown_handler_that_does_not_return_is_abandoned(trial):
    never = threading.Event()
    t = trial(
        fake_process("a"), on_shutdown(lambda *_: never.wait()), on_shutdown(LogInfo(msg="bye"))
    )
    t.supervisor.stop("test")
    t.advance(HANDLER_TIMEOUT_S)
    assert t.asked_to_stop() == {"a"}
    assert "an event handler has not returned after 5 s" in t.screen.problems[-1]
    t["a"].end(0)
    assert "bye" not in t.screen.lines
    assert t.finish() == 0
    never.set()


@pytest.mark.parametrize("by_itself", [True, False])
def test_a_forced_stop_waits_for_no_shutdown_handler(trial, by_itself):
    never = threading.Event()
    t = trial(fake_process("a"), on_shutdown(lambda *_: never.wait()))
    if by_itself:
        t["a"].end(0)
        t.supervisor.finish_idle()
    else:
        t.supervisor.stop("first")
    assert not t.supervisor.done
    t.supervisor.kill("second")
    assert t.finish() == 130
    never.set()


@pytest.mark.parametrize("mistake", [lambda: {}["missing"], lambda: exit(7)])
@pytest.mark.parametrize("by_itself", [True, False])
def test_a_mistake_in_a_shutdown_handler_is_reported_in_the_last_line(trial, by_itself, mistake):
    t = trial(fake_process("a"), on_shutdown(lambda *_: mistake()), on_shutdown(LogInfo(msg="bye")))
    if not by_itself:
        t.supervisor.stop("test")
    t["a"].end(0)
    assert t.finish() == 1
    assert "bye" in t.screen.lines
    assert "an event handler: " in str(t.screen.last_line)


# Real processes


PATIENT = """
from launch_py.supervision import event_handling

event_handling.HANDLER_TIMEOUT_S = 100.0
"""


@pytest.fixture
def launch_patiently(launch):
    """Launch actions whose handlers have as long as they need on a busy machine."""
    return lambda actions: launch(PATIENT + textwrap.dedent(actions))


def test_real_exits_during_a_shutdown(launch_patiently):
    launched = launch_patiently(
        """
        def tell(event, context):
            sys.stdout.write(f"{event.process_name} FN\\n")

        a = python("a", "print('done')", depends_on="b", on_exit=Shutdown())
        b = forever("b", on_exit=[LogInfo(msg="B EXIT LOGGED")])
        handlers = [OnProcessExit(target_action=p, on_exit=tell) for p in (a, b)]
        actions = [a, b, *map(RegisterEventHandler, handlers)]
        """
    )
    assert launched.wait() == 0, launched.output
    assert "[launch] B EXIT LOGGED" in launched.lines
    assert "a FN" in launched.lines
    assert "b FN" in launched.lines


@pytest.mark.parametrize(
    "actions",
    [
        'forever("a", on_exit=hang)',
        'forever("a"), RegisterEventHandler(OnShutdown(on_shutdown=hang))',
    ],
)
def test_a_second_ctrl_c_stops_at_once_even_if_a_function_hangs(launch, actions):
    launched = launch(
        f"""
        import time

        def hang(event, context):
            print("HANGING", flush=True)
            time.sleep(1000)

        actions = [{actions}]
        """
    )
    launched.wait_for("^ready ")
    launched.process.send_signal(signal.SIGINT)
    launched.wait_for("HANGING")
    while launched.process.poll() is None:  # One that comes at once counts as the first.
        launched.process.send_signal(signal.SIGINT)
    assert launched.wait() == 130, launched.output


def test_a_process_that_a_function_runs_keeps_its_exit_code(launch_patiently):
    launched = launch_patiently(
        """
        import subprocess

        def tell(event, context):
            fail = ["sh", "-c", "sleep 0.02; exit 3"]
            codes = [subprocess.run(fail, start_new_session=i % 2).returncode for i in range(10)]
            for _ in range(10):
                child = subprocess.Popen(fail)
                while child.poll() is None:
                    pass
                codes.append(child.returncode)
            print("CODES", set(codes), flush=True)

        actions = [forever("a", on_exit=tell)]
        """
    )
    launched.wait_for("^ready ")
    launched.process.send_signal(signal.SIGINT)
    assert launched.wait() == 0, launched.output
    assert "CODES {3}" in launched.lines


def test_a_process_that_a_function_left_running_keeps_its_exit_code(launch_patiently):
    launched = launch_patiently(
        """
        import subprocess
        children = []

        def begin(event, context):
            children.append(subprocess.Popen(["sh", "-c", "exit 3"]))

        def tell(event, context):
            print("CODE", children[0].wait(), flush=True)

        a = forever("a", on_exit=tell)
        b = python("b", "import time; time.sleep(0.2)", ready=Finished())
        actions = [a, b, RegisterEventHandler(OnProcessStart(target_action=a, on_start=begin))]
        """
    )
    launched.wait_for("^ready ")
    launched.process.send_signal(signal.SIGINT)
    assert launched.wait() == 0, launched.output
    assert "CODE 3" in launched.lines
