import pytest

from arm_control.control_loop import ControlLoop
from arm_control.pacer import Pacer
from arm_gazebo.world.refusal import Refusal, RefusedError
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
        with pytest.raises(RefusedError) as caught:
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


def test_whoever_pauses_the_loop_counts(run):
    run.control.go_to(RunState.PLAYING)
    run.loop.pause().result(30.0)
    assert run.control.state is RunState.PAUSED


def test_a_state_that_is_there_is_refused(run):
    kind = run.refusal(lambda: run.control.go_to(RunState.PAUSED))
    assert kind is Refusal.ALREADY_THERE


def test_without_a_world_nothing_plays(run):
    run.control.stand(RunState.NO_WORLD)
    kind = run.refusal(lambda: run.control.go_to(RunState.PLAYING))
    assert kind is Refusal.INCORRECT_TRANSITION
    assert run.refusal(lambda: run.control.step(1)) is Refusal.INCORRECT_STATE


@pytest.mark.parametrize("before", [RunState.PLAYING, RunState.PAUSED])
def test_a_world_that_is_refused_leaves_the_state_as_it_was(run, before):
    def refuse() -> None:
        with run.control.to_stand(RunState.NO_WORLD):
            assert run.control.state is RunState.NO_WORLD
            raise RefusedError(Refusal.FAILED, "the world cannot be like that")

    if before is RunState.PLAYING:
        run.control.go_to(before)
    assert run.refusal(refuse) is Refusal.FAILED
    assert run.control.state is before
    with run.control.to_stand(RunState.STOPPED):
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
