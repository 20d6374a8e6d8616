"""Whether the simulated time runs, and what may follow on what."""

from collections.abc import Callable, Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from enum import Enum

from arm_control.control_loop import ControlLoop
from arm_gazebo.world.refusal import Refusal, RefusedError


class RunState(Enum):
    """States of a simulation; the values are those of simulation_interfaces."""

    STOPPED = 0
    PLAYING = 1
    PAUSED = 2
    QUITTING = 3
    NO_WORLD = 4


class RunControl:
    """Starts, pauses, stops and steps a control loop; one thread, which is not the loop's.

    A stopped simulation is a paused one that starts anew.

    Args:
        loop: runs the simulation; its own `paused` counts, whoever paused it.
        reset: puts everything back to where it started.
        quit_process: asks the process to end.
    """

    def __init__(
        self, loop: ControlLoop, reset: Callable[[], None], quit_process: Callable[[], None]
    ) -> None:
        self._loop = loop
        self._reset = reset
        self._quit = quit_process
        self._standing = RunState.PAUSED

    @property
    def state(self) -> RunState:
        """The state now."""
        return self._standing if self._loop.paused else RunState.PLAYING

    def go_to(self, target: RunState) -> None:
        """Change the state.

        Raises:
            RefusedError: it is in that state, or cannot come to it from here.
        """
        ends_steps = target is RunState.PAUSED and self._loop.stepping
        if target is self.state and not ends_steps:
            raise RefusedError(Refusal.ALREADY_THERE, f"the simulation is {target.name} already")
        if target is RunState.QUITTING:
            self._quit()
        elif target is RunState.NO_WORLD or self.state is RunState.NO_WORLD:
            raise RefusedError(
                Refusal.INCORRECT_TRANSITION,
                f"from {self.state.name} to {target.name} leads no way but loading or unloading "
                "a world",
            )
        elif target is RunState.PLAYING:
            self._loop.resume().result()
        else:
            self.stand(target)
            if target is RunState.STOPPED:
                self._reset()

    def stand(self, state: RunState) -> None:
        """Let time stand still, and call it this state."""
        self._loop.pause().result()
        self._standing = state

    @contextmanager
    def to_stand(self, state: RunState) -> Iterator[None]:
        """Let time stand still for what leads to this state; where refused, all is as before."""
        standing, paused = self._standing, self._loop.paused
        self.stand(state)
        try:
            yield
        except RefusedError:
            self._standing = standing
            if not paused:
                self._loop.resume().result()
            raise

    def step(self, count: int) -> "Future[int]":
        """Advance a paused simulation by control periods; see `ControlLoop.step`.

        Raises:
            RefusedError: time runs, there is no world, or the number is none.
        """
        if self.state not in (RunState.PAUSED, RunState.STOPPED):
            raise RefusedError(
                Refusal.INCORRECT_STATE,
                f"steps are for a paused simulation; this one is {self.state.name}",
            )
        if count < 1:
            raise RefusedError(Refusal.FAILED, f"the number of steps is {count}; 1 is the least")
        self._standing = RunState.PAUSED
        return self._loop.step(count)
