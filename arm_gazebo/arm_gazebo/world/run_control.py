"""The run state of the simulation and its allowed transitions."""

from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from enum import Enum

from arm_control.loop.control_loop import ControlLoop
from arm_gazebo.errors import Refusal, RequestError


class RunState(Enum):
    """States of a simulation; the values are those of simulation_interfaces."""

    STOPPED = 0
    PLAYING = 1
    PAUSED = 2
    QUITTING = 3
    NO_WORLD = 4


class RunControl:
    """Starts, pauses, stops and steps a control loop. One thread other than the loop's.

    A stopped simulation is a paused one that was reset. The loop's `paused` is authoritative,
    whoever paused it.
    """

    def __init__(
        self, loop: ControlLoop, reset: Callable[[], None], quit_process: Callable[[], None]
    ) -> None:
        self._loop = loop
        self._reset = reset
        self._quit = quit_process
        self._state_while_paused = RunState.PAUSED
        self._changes = 0
        self._runs_of_steps = 0

    @property
    def state(self) -> RunState:
        """The present state."""
        return self._state_while_paused if self._loop.paused else RunState.PLAYING

    def go_to(self, target: RunState) -> None:
        """Change the state.

        Raises:
            RequestError: it is already in that state, or the transition is not allowed.
        """
        stepping = self._loop.stepping or self._runs_of_steps > 0
        ends_steps = target is RunState.PAUSED and stepping
        if target is self.state and not ends_steps:
            raise RequestError(Refusal.ALREADY_THERE, f"the simulation is already {target.name}")
        if target is RunState.QUITTING:
            self._quit()
        elif target is RunState.NO_WORLD or self.state is RunState.NO_WORLD:
            raise RequestError(
                Refusal.INCORRECT_TRANSITION,
                f"only loading or unloading a world leads from {self.state.name} to {target.name}",
            )
        elif target is RunState.PLAYING:
            self._changes += 1
            self._loop.resume().result()
        else:
            self.pause_as(target)
            if target is RunState.STOPPED:
                self._reset()

    def pause_as(self, state: RunState) -> None:
        """Pause the simulation in this state."""
        self._changes += 1
        self._loop.pause().result()
        self._state_while_paused = state

    @contextmanager
    def paused_as(self, state: RunState) -> Iterator[None]:
        """Pause in this state for the body of `with`; a RequestError in it restores the old one."""
        before, paused = self._state_while_paused, self._loop.paused
        self.pause_as(state)
        try:
            yield
        except RequestError:
            self._state_while_paused = before
            if not paused:
                self._loop.resume().result()
            raise

    def step(self, count: int) -> "Future[int]":
        """Advance a paused simulation by control periods; see `ControlLoop.step`.

        Raises:
            RequestError: the simulation is not paused, has no world, or the number is below 1.
        """
        self._check_step(count)
        self._state_while_paused = RunState.PAUSED
        return self._loop.step(count)

    @contextmanager
    def run_of_steps(self, count: int) -> Iterator[Callable[[], bool]]:
        """Yield a function that returns whether single steps may go on: until the state is changed.

        Raises:
            RequestError: as in `step`.
        """
        self._check_step(count)
        changes = self._changes
        self._runs_of_steps += 1
        try:
            yield lambda: self._changes == changes
        finally:
            self._runs_of_steps -= 1

    def _check_step(self, count: int) -> None:
        if self.state not in (RunState.PAUSED, RunState.STOPPED):
            raise RequestError(
                Refusal.INCORRECT_STATE,
                f"only a paused simulation can be stepped; this one is {self.state.name}",
            )
        if count < 1:
            raise RequestError(
                Refusal.FAILED, f"the number of steps is {count}; it must be at least 1"
            )
