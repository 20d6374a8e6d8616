import pytest

from arm_control.loop.control_loop import ControlLoop
from arm_control.loop.pacer import Pacer
from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.world.run_control import RunControl, RunState


class Run:
    """A loop that counts its ticks, and the control of it."""

    def __init__(self) -> None:
        self.ticks = 0
        self.did: list[str] = []
        self.loop = ControlLoop(self._tick, Pacer(0.01))
        self.control = RunControl(
            self.loop, lambda: self.did.append("reset"), lambda: self.did.append("quit")
        )
        self.loop.start(paused=True)

    def _tick(self) -> None:
        self.ticks += 1

    def refusal(self, action) -> Refusal:
        with pytest.raises(RequestError) as caught:
            action()
        assert str(caught.value)
        return caught.value.refusal


@pytest.fixture
def run():
    made = Run()
    yield made
    made.loop.stop()
    assert made.loop.join(30.0)


def test_playing_pausing_and_stopping(run):
    control = run.control
    assert control.state is RunState.PAUSED
    for target in (RunState.PLAYING, RunState.STOPPED, RunState.PLAYING, RunState.PAUSED):
        control.go_to(target)
        assert control.state is target
    assert run.did == ["reset"]


def test_the_loops_own_pause_is_authoritative(run):
    run.control.go_to(RunState.PLAYING)
    run.loop.pause().result(30.0)
    assert run.control.state is RunState.PAUSED


def test_a_state_that_is_there_is_refused(run):
    kind = run.refusal(lambda: run.control.go_to(RunState.PAUSED))
    assert kind is Refusal.ALREADY_THERE


def test_without_a_world_nothing_plays(run):
    run.control.pause_as(RunState.NO_WORLD)
    kind = run.refusal(lambda: run.control.go_to(RunState.PLAYING))
    assert kind is Refusal.INCORRECT_TRANSITION
    assert run.refusal(lambda: run.control.step(1)) is Refusal.INCORRECT_STATE


@pytest.mark.parametrize("before", [RunState.PLAYING, RunState.PAUSED])
def test_a_world_that_is_refused_leaves_the_state_as_it_was(run, before):
    def refuse() -> None:
        with run.control.paused_as(RunState.NO_WORLD):
            assert run.control.state is RunState.NO_WORLD
            raise RequestError(Refusal.FAILED, "the world cannot be changed")

    if before is RunState.PLAYING:
        run.control.go_to(before)
    assert run.refusal(refuse) is Refusal.FAILED
    assert run.control.state is before
    with run.control.paused_as(RunState.STOPPED):
        pass
    assert run.control.state is RunState.STOPPED


def test_quitting_is_asked_for(run):
    run.control.go_to(RunState.QUITTING)
    assert run.did == ["quit"]


def test_steps_of_a_paused_simulation(run):
    assert run.control.step(7).result(30.0) == 7
    assert run.ticks == 7
    assert run.control.state is RunState.PAUSED


@pytest.mark.parametrize("state", [RunState.PAUSED, RunState.STOPPED, RunState.PLAYING])
def test_a_state_asked_for_ends_steps(run, state):
    steps = run.control.step(10_000_000)
    run.loop.call(lambda: None).result(30.0)  # the loop knows of them
    run.control.go_to(state)
    assert steps.result(30.0) < 10_000_000
    assert run.control.state is state


def test_no_steps_while_time_runs(run):
    run.control.go_to(RunState.PLAYING)
    assert run.refusal(lambda: run.control.step(1)) is Refusal.INCORRECT_STATE


def test_no_steps_are_no_number_of_steps(run):
    assert run.refusal(lambda: run.control.step(0)) is Refusal.FAILED


def test_single_steps_go_on_until_somebody_changes_the_state(run):
    with run.control.run_of_steps(100) as goes_on:
        assert run.control.step(1).result(30.0) == 1
        assert goes_on()
        # Between two steps the loop stands still, but the run of steps can be ended.
        run.control.go_to(RunState.PAUSED)
        assert not goes_on()
    assert run.refusal(lambda: run.control.go_to(RunState.PAUSED)) is Refusal.ALREADY_THERE


def test_a_run_of_steps_is_refused_like_steps(run):
    def begin(count: int) -> None:
        with run.control.run_of_steps(count):
            pass

    assert run.refusal(lambda: begin(0)) is Refusal.FAILED
    run.control.go_to(RunState.PLAYING)
    assert run.refusal(lambda: begin(1)) is Refusal.INCORRECT_STATE
