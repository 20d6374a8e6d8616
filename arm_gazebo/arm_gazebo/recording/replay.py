"""Run a recorded run again, and compare each state with the recorded one."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from arm_control.controllers.controller import ControllerContext
from arm_control.errors import ArmControlError
from arm_control.manager.controller_manager import ControllerManager
from arm_control.manager.registry import controller_class
from arm_control.run_inputs import is_run_input
from arm_description.errors import DescriptionError
from arm_gazebo.errors import GazeboError, RecordingError
from arm_gazebo.model.built_model import SavedModel
from arm_gazebo.recording.recorded_run import run_of
from arm_gazebo.recording.run_file import RecordedInput, RecordedPeriod, RecordingEnd, RunFile
from arm_gazebo.recording.run_state import Row, StateRow, chained_hashes, state_names
from arm_gazebo.run.robot import SimulatedRobot
from arm_gazebo.state.complete_state import CompleteState

MAX_NAMED = 6


@dataclass(frozen=True, slots=True)
class Difference:
    """The first control period in which a replay differs from its recording.

    Attributes:
        period: its number, counted from 0.
        time_s: simulation time at its end.
        lines: what differs, a line each.
    """

    period: int
    time_s: float
    lines: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ReplayResult:
    """What a replay has found.

    Attributes:
        periods: control periods that were compared.
        time_s: simulation time at the end.
        difference: the first one; None if all periods are equal.
        is_cut_off: whether the recording was not finished, as of a killed process.
        end_reason: why the recording ended; "" if its user ended it.
    """

    periods: int
    time_s: float
    difference: Difference | None
    is_cut_off: bool
    end_reason: str = ""


class Replay:
    """A recorded run that runs again. One thread.

    Raises:
        GazeboError, ArmControlError, DescriptionError: the run cannot be built with what is here.

    Attributes:
        file: the recording.
        simulation: the physics.
        robots: its robots with their controller managers.
        periods: control periods that have run.
    """

    def __init__(self, file: RunFile) -> None:
        self.file = file
        self._run = run = run_of(file).build()
        self.simulation, self.robots = run.physics, run.robots
        self.periods = 0
        self._hash = 0
        self._state = StateRow(run.physics, run.managers)

    def run(
        self,
        until_s: float = math.inf,
        after_period: Callable[[], object] = lambda: None,
        before_input: Callable[[RecordedInput], object] = lambda _: None,
    ) -> ReplayResult:
        """Run and compare, as fast as possible, up to the first difference.

        Args:
            until_s: simulation time at which to stop.
            after_period: called after each period that is equal.
            before_input: called with each input before it is given again.

        Raises:
            RecordingError: the recording is damaged.
        """
        difference = end = None
        for period in self.file.periods():
            if isinstance(period, RecordingEnd):
                end = period
                continue
            if self.simulation.time_s + 0.5 * self.simulation.timing.period_s >= until_s:
                break
            difference = self._give(period, before_input)
            if difference is None:
                self._run.tick()
                difference = self._compare(period)
            if difference is not None:
                break
            self.periods += 1
            after_period()
        return ReplayResult(
            periods=self.periods,
            time_s=self.simulation.time_s,
            difference=difference,
            is_cut_off=end is None and difference is None and until_s == math.inf,
            end_reason="" if end is None else end.reason,
        )

    def _give(
        self, period: RecordedPeriod, before_input: Callable[[RecordedInput], object]
    ) -> Difference | None:
        """Give a period's inputs again; return a difference if one ends in another way."""
        for recorded in period.inputs:
            before_input(recorded)
            reason = ""
            try:
                self._act(recorded)
            except (ArmControlError, GazeboError, DescriptionError, ValueError) as error:
                reason = str(error)
            if bool(reason) != recorded.raised:
                then = "was refused" if recorded.raised else "was accepted"
                now = f"is refused: {reason}" if reason else "is accepted"
                what = " ".join(filter(None, (recorded.controller, recorded.method)))
                line = f"input {what} {then}, but {now}"
                return Difference(recorded.period, self.simulation.time_s, (line,))
        return None

    def _act(self, recorded: RecordedInput) -> None:
        arguments = dict(recorded.arguments)
        if recorded.robot is None:
            if recorded.method == "swap":
                self._swap(arguments["model"], arguments["roots"])
                return
            target: Any = self.simulation
            if hasattr(CompleteState, recorded.method):
                target = self._run.state
        else:
            robot = self._robot(recorded)
            target = robot.manager
            if recorded.controller is not None:
                managed = robot.manager.controllers.get(recorded.controller)
                target = managed and managed.controller
            elif recorded.method == "load_controller":
                arguments["controller"] = _controller(robot, arguments)
        method = getattr(target, recorded.method, None)
        if not is_run_input(method):
            # A file from a stranger must not call anything else.
            raise RecordingError(
                f"{self.file.path}: there is no input '{recorded.method}' of "
                f"{recorded.controller or 'the simulation'}"
            )
        method(**arguments)

    def _robot(self, recorded: RecordedInput) -> SimulatedRobot:
        index = recorded.robot
        if index is None or not 0 <= index < len(self.robots):
            raise RecordingError(f"{self.file.path} has no robot number {index}")
        return self.robots[index]

    def _swap(self, model: SavedModel, roots: tuple[str, ...]) -> None:
        following = self.simulation.prepare(model.load(), roots)
        self.simulation.swap(following)
        for holder in self._run.holders:
            holder.rebind()
        self._state = StateRow(self.simulation, self._run.managers)

    def _compare(self, period: RecordedPeriod) -> Difference | None:
        state = self._state.copy(self.simulation.time_s)
        (self._hash,) = chained_hashes(self._hash, [state])
        if self._hash == period.hash:
            return None
        recorded = period.block.state(period.number)
        if recorded is None:
            lines = ["the hash of the state differs; the state itself was not recorded here"]
        else:
            names = state_names(self.simulation.model, self._run.managers)
            lines = differing(names, recorded, np.frombuffer(state))
        return Difference(period.number, self.simulation.time_s, tuple(lines))


def differing(names: list[str], recorded: Row, now: Row) -> list[str]:
    """Return a line for each of the largest differences of two states.

    Commands come first, because what else differs may follow from them; then the largest.
    """
    if len(recorded) != len(now):
        return [f"the state has {len(now)} numbers, {len(recorded)} in the recording"]
    is_equal = (recorded == now) | (np.isnan(recorded) & np.isnan(now))
    where = np.flatnonzero(~is_equal)
    if not len(where):
        return ["an earlier state differs; its recorded state is not stored"]
    sizes = np.abs(now[where] - recorded[where])
    by_size = where[np.argsort(-np.nan_to_num(sizes, nan=math.inf))]
    order = np.array(sorted(by_size, key=lambda i: not names[i].startswith("command ")))
    lines = [
        f"{names[i]}: {float(now[i])} instead of {float(recorded[i])}, "
        f"by {now[i] - recorded[i]:.3g}"
        for i in order[:MAX_NAMED].tolist()
    ]
    more = len(order) - MAX_NAMED
    return [*lines, f"and {more} more numbers"] if more > 0 else lines


def _controller(robot: SimulatedRobot, arguments: dict[str, Any]) -> Any:
    manager: ControllerManager = robot.manager
    context = ControllerContext.of(
        str(arguments["controller"]), manager.update_rate_hz, robot.document
    )
    return controller_class(str(arguments["type_name"]))(context)
