"""Order of starts and stops, readiness, restarts and exit codes, with fake processes and clock."""

import pytest

from launch_py import (
    ExecuteProcess,
    Finished,
    LogInfo,
    LogLine,
    Notified,
    OpaqueFunction,
    RegisterEventHandler,
    RestartPolicy,
    Shutdown,
    TimerAction,
    TopicPublished,
)
from launch_py.event_handlers import OnProcessExit, OnProcessStart
from launch_py.testing import fake_process

UP = LogLine("up")


def test_a_process_without_condition_is_ready_when_started(trial):
    t = trial(fake_process("b", depends_on="a"), fake_process("a"))
    assert t.started == ["a", "b"]
    assert t.screen.ready_after_s == 0.0


def test_starts_follow_readiness(trial):
    t = trial(fake_process("a", ready=UP), fake_process("b", ready=UP, depends_on="a"))
    assert t.started == ["a"]
    t["a"].write("not yet")
    assert t.started == ["a"]
    t["a"].write("now up")
    assert t.started == ["a", "b"]
    assert t.screen.ready_after_s is None
    t.clock.advance(1.25)
    t["b"].write("up", "stderr")
    assert t.screen.ready_after_s == 1.25
    assert t.runner.is_settled


def test_all_of_several_conditions_must_hold(trial):
    topic = TopicPublished("/a")
    t = trial(fake_process("a", ready=[UP, Notified(), topic]))
    t["a"].write("up")
    t.runner.watched[topic]()
    assert t.screen.ready_after_s is None
    t.supervisor.processes["a"].notified({"READY": "1"})
    assert t.screen.ready_after_s == 0.0


def test_a_one_shot_is_ready_when_it_has_exited(trial):
    t = trial(fake_process("spawner", ready=Finished()), fake_process("b", depends_on="spawner"))
    assert t.started == ["spawner"]
    t["spawner"].end(0)
    assert t.started == ["spawner", "b"]


def test_a_one_shot_that_fails_ends_the_launch_with_its_code(trial):
    t = trial(fake_process("spawner", ready=Finished()), fake_process("b", depends_on="spawner"))
    t["spawner"].end(3)
    assert t.finish() == 3
    assert t.started == ["spawner"]
    assert "spawner ended with exit code 3" in str(t.screen.last_line)


def test_a_time_out_says_what_is_missing_and_ends_everything(trial):
    condition = LogLine("up", timeout_s=5.0)
    t = trial(fake_process("a", ready=[condition, TopicPublished("/clock", timeout_s=9.0)]))
    t.advance(5.0)
    assert t.asked_to_stop() == {"a"}
    t["a"].end(0)
    assert t.finish() == 1
    assert "a is not ready after 5 s: no line in its output matches 'up'" in str(t.screen.last_line)
    assert "no publisher on topic /clock" in str(t.screen.last_line)


def test_a_process_that_is_ready_in_time_is_not_late(trial):
    t = trial(fake_process("a", ready=LogLine("up", timeout_s=5.0)))
    t["a"].write("up")
    t.advance(10.0)
    assert t.asked_to_stop() == set()


@pytest.mark.parametrize(
    ("code", "launch_code", "said"),
    [
        (4, 4, "exit code 4 after 0.00 s, before it was ready"),
        (0, 1, "exit code 0 after 0.00 s, before it was ready: no line in its output matches 'up'"),
    ],
)
def test_an_exit_before_readiness_ends_the_launch(trial, code, launch_code, said):
    t = trial(fake_process("a", ready=UP), fake_process("b"))
    t["a"].end(code)
    assert t.asked_to_stop() == {"b"}
    t["b"].end(0)
    assert t.finish() == launch_code
    assert str(t.screen.last_line).endswith(f"a ended with {said}")


def test_a_process_that_cannot_be_started_ends_the_launch(trial):
    t = trial(fake_process("a"), fake_process("b"), cannot_start=["b"])
    assert t.asked_to_stop() == {"a"}
    t["a"].end(0)
    assert t.finish() == 127
    assert "b could not be started: no such program" in str(t.screen.last_line)


def test_a_failure_of_a_process_that_nothing_needs_is_reported_only(trial):
    t = trial(fake_process("a"), fake_process("b"))
    t["a"].end(139)
    assert t.screen.problems == ["a was killed by SIGSEGV after 0.00 s"]
    assert not t.supervisor.stopping


def test_when_all_have_ended_the_first_failure_is_the_exit_code(trial):
    t = trial(fake_process("a"), fake_process("b"), fake_process("c"))
    t["a"].end(0)
    t["b"].end(7)
    t["c"].end(8)
    assert t.finish() == 7


def test_when_all_have_succeeded_the_exit_code_is_0(trial):
    t = trial(fake_process("a"))
    t["a"].end(0)
    assert t.finish() == 0


def test_a_required_process_ends_the_launch_with_its_code(trial):
    t = trial(fake_process("a", on_exit=Shutdown()), fake_process("b"))
    t["a"].end(6)
    assert t.asked_to_stop() == {"b"}
    t["b"].end(0)
    assert t.finish() == 6
    assert "a ended with exit code 6" in str(t.screen.last_line)


def test_a_required_process_that_succeeds_ends_the_launch_with_success(trial):
    t = trial(fake_process("a", on_exit=Shutdown(reason="done")), fake_process("b"))
    t["a"].end(0)
    t["b"].end(1)
    assert t.finish() == 0
    assert "stopping: done" in t.screen.lines


def test_processes_stop_in_the_reverse_order_of_dependencies(trial):
    t = trial(
        fake_process("a"),
        fake_process("b", depends_on="a"),
        fake_process("c", depends_on="b"),
        fake_process("d"),
    )
    t.supervisor.stop("test")
    assert t.asked_to_stop() == {"c", "d"}
    t["d"].end(0)
    assert t.asked_to_stop() == {"c", "d"}
    t["c"].end(0)
    assert t.asked_to_stop() == {"b", "c", "d"}
    t["b"].end(0)
    assert t.asked_to_stop() == {"a", "b", "c", "d"}
    t["a"].end(1)
    assert t.finish() == 0


def test_after_a_stop_nothing_new_starts(trial):
    t = trial(fake_process("a", ready=UP), fake_process("b", depends_on="a"))
    t.supervisor.stop("test")
    t["a"].write("up")
    t["a"].end(0)
    assert t.started == ["a"]
    assert t.screen.ready_after_s is None


def test_a_quick_stop_stops_all_at_once(trial):
    t = trial(fake_process("a"), fake_process("b", depends_on="a"))
    t.supervisor.stop_quickly("test")
    assert t.asked_to_stop() == {"a", "b"}
    assert t["a"].stop_delays is not None
    assert t["a"].stop_delays.sigkill_timeout_s == 1.0


def test_a_forced_stop_kills_all_and_shows_in_the_exit_code(trial):
    t = trial(fake_process("a"), fake_process("b", depends_on="a"))
    t.supervisor.stop("first")
    t.supervisor.kill("second")
    assert t["a"].killed
    assert t["b"].killed
    assert t.finish() == 130


def test_a_process_that_had_to_be_killed_shows_in_the_exit_code(trial):
    t = trial(fake_process("a"))
    t.supervisor.stop("test")
    t["a"].killed = True
    t["a"].end(137)
    assert t.finish() == 137
    assert "a did not stop and was killed" in str(t.screen.last_line)


def test_a_failed_process_is_restarted_after_its_delay(trial):
    t = trial(fake_process("a", restart=RestartPolicy.on_failure()))
    t["a"].end(1)
    t.advance(0.4)
    assert t.started == ["a"]
    assert not t.supervisor.done
    t.advance(0.2)
    assert t.started == ["a", "a"]
    assert "a ended with exit code 1 after 0.00 s; restart in 0.5 s" in t.screen.problems


def test_a_crash_loop_is_reported_and_not_restarted(trial):
    t = trial(fake_process("a", restart=RestartPolicy.on_failure(), on_exit=Shutdown()))
    for delay_s in (0.5, 1.0, 2.0, 4.0):
        t["a"].end(9)
        t.advance(delay_s)
    t["a"].end(9)
    assert t.finish() == 9
    assert "giving up: it failed 5 times within 30 s" in str(t.screen.last_line)


def test_a_restart_that_is_due_does_not_happen_after_a_stop(trial):
    t = trial(fake_process("a", restart=RestartPolicy.always()))
    t["a"].end(0)
    t.supervisor.stop("test")
    t.advance(10.0)
    assert t.started == ["a"]
    assert t.finish() == 0


def test_a_process_may_become_ready_in_its_second_run(trial):
    t = trial(
        fake_process("a", ready=UP, restart=RestartPolicy.on_failure()),
        fake_process("b", depends_on="a"),
    )
    t["a"].end(1)
    t.advance(0.5)
    t["a"].write("up")
    assert t.started == ["a", "a", "b"]


def test_handlers_of_starts_and_exits(trial):
    a = fake_process("a")
    t = trial(
        a,
        RegisterEventHandler(OnProcessStart(target_action=a, on_start=fake_process("b"))),
        RegisterEventHandler(
            OnProcessExit(target_action=a, on_exit=[LogInfo(msg="x"), fake_process("c")])
        ),
    )
    assert t.started == ["a", "b"]
    t["a"].end(0)
    assert t.started == ["a", "b", "c"]
    assert "x" in t.screen.lines


def test_exit_handlers_wait_for_the_last_exit(trial):
    t = trial(fake_process("a", restart=RestartPolicy.on_failure(), on_exit=fake_process("b")))
    t["a"].end(1)
    t.advance(0.5)
    assert t.started == ["a", "a"]
    t["a"].end(0)
    assert t.started == ["a", "a", "b"]


def test_a_function_as_handler_gets_the_event(trial):
    events = []

    def on_exit(event, _context):
        events.append((event.process_name, event.returncode, event.pid))
        return [fake_process("b", depends_on="c"), fake_process("c")]

    t = trial(fake_process("a", on_exit=on_exit))
    assert not t.supervisor.done
    t["a"].end(2)
    assert events == [("a", 2, 1001)]
    assert t.started == ["a", "c", "b"]


def test_a_handler_that_raises_ends_the_launch_with_a_message(trial):
    t = trial(
        fake_process("b"),
        fake_process(
            "a", on_exit=lambda _event, _context: ExecuteProcess(cmd=["no-such-program-x"])
        ),
    )
    t["a"].end(0)
    t["b"].end(0)
    assert t.finish() == 1
    assert "no program 'no-such-program-x'" in str(t.screen.last_line)


@pytest.mark.parametrize(
    ("handler", "said"),
    [
        (lambda event, _context: event.no_such_thing, "an event handler: AttributeError"),
        (lambda _event, _context: 3, "an event handler takes actions, not 3 of type int"),
        (lambda *_: fake_process("b", prefix="'"), "an ExecuteProcess of b: ValueError"),
        (
            OpaqueFunction(function=lambda _context: 3),
            "an event handler takes actions, not 3 of type int",
        ),
    ],
)
def test_a_handler_with_invalid_actions_ends_the_launch_with_a_message(trial, handler, said):
    t = trial(fake_process("a", on_exit=handler))
    t["a"].end(0)
    assert t.finish() == 1
    assert said in str(t.screen.last_line)


def test_a_step_that_waits_for_a_process_does_not_wait_for_its_handlers(trial):
    a = fake_process("a", on_exit=fake_process("mourner"))
    t = trial(a, fake_process("b", depends_on=a))
    assert t.started == ["a", "b"]


def test_a_timer_keeps_the_launch_alive(trial):
    t = trial(TimerAction(period=2.0, actions=[fake_process("a")]))
    assert not t.supervisor.done
    t.advance(2.0)
    assert t.started == ["a"]


def test_the_status_lists_pending_processes_and_their_status(trial):
    t = trial(fake_process("a", ready=UP), fake_process("b", depends_on="a"))
    assert t.supervisor.status() == "up 0:00 · 1 process · waiting for a, b"
    t["a"].write("up")
    t.supervisor.processes["a"].notified({"STATUS": "100 Hz"})
    t.clock.advance(65)
    assert t.supervisor.status() == "up 1:05 · 2 processes · 100 Hz"


def test_a_process_s_remark_is_shown_when_everything_is_ready(trial):
    t = trial(fake_process("a", ready=Notified()), fake_process("b"))
    t.supervisor.processes["a"].notified({"X_REMARK": "3 things are left out"})
    t.supervisor.processes["a"].notified({"READY": "1"})
    assert ("a", "3 things are left out") in t.screen.summary.notes


def test_only_the_shown_streams_reach_the_screen(trial, tmp_path):
    t = trial(fake_process("a", output="log"))
    t["a"].write("quiet")
    t["a"].write("loud", "stderr")
    assert "[a] loud" in t.screen.lines
    assert "[a] quiet" not in t.screen.lines
    log = tmp_path / "latest" / "a.log"
    assert [line.split(" ", 1)[1] for line in log.read_text().splitlines()] == ["quiet", "loud"]
