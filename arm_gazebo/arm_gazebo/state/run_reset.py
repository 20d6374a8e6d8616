"""Reset a run, wholly or in part, in one tick."""

from collections.abc import Callable

from arm_control.errors import StateError
from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.state.complete_state import CompleteState
from arm_gazebo.world.editor import WorldEditor
from arm_node.frozen import frozen


@frozen
class ResetScope:
    """What a reset covers.

    Attributes:
        time: the clock.
        state: poses, velocities, drives, controllers, noise, and things that were moved.
        spawned: things that were spawned or deleted.
    """

    time: bool = True
    state: bool = True
    spawned: bool = True


EVERYTHING = ResetScope()


class RunReset:
    """Resets a run. One thread other than the loop's.

    `resets_clock` returns whether a reset of everything sets the clock to zero. `on_reset` is
    called on the loop thread after each reset, to restart the figures.
    """

    def __init__(
        self,
        state: CompleteState,
        editor: WorldEditor,
        resets_clock: Callable[[], bool],
        on_reset: Callable[[], None],
    ) -> None:
        self._state = state
        self._editor = editor
        self._resets_clock = resets_clock
        self._on_reset = on_reset

    def reset(self, scope: ResetScope = EVERYTHING) -> None:
        """Reset what the scope covers, before the next tick.

        Raises:
            RequestError: the scope names the clock, which the parameter excludes; or controllers
                could not be reset, which the message names.
        """
        clock = self._resets_clock()
        if scope.time and scope != EVERYTHING and not clock:
            raise RequestError(
                Refusal.UNSUPPORTED,
                "the clock is not reset, because the parameter reset_clock is false",
            )
        refused: list[str] = []

        def begin() -> None:
            try:
                if scope.state:
                    self._state.reset(scope.time and clock)
                elif scope.time:
                    self._state.set_clock(0.0)
            except StateError as error:
                # Not raised here: the world has changed, and the editor must know its model.
                refused.append(str(error))
            self._on_reset()

        self._editor.undo(scope.spawned, scope.state, begin)
        if refused:
            raise RequestError(Refusal.FAILED, "; ".join(refused))
