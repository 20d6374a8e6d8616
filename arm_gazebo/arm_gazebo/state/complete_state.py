"""The complete state of a run between two ticks: physics, drives, controllers, noise, clock."""

from collections.abc import Iterator, Mapping, Sequence
from hashlib import blake2b
from itertools import zip_longest
from typing import Any

from arm_control.errors import StateError
from arm_control.manager.controller_manager import ControllerManager
from arm_control.run_inputs import InputGate, run_input
from arm_control.state.encoding import decode, encode
from arm_gazebo.feed.schedule import FrameSchedule
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics.tick import ClockPublisher, SilentClock

DIGEST_BYTES = 16


class CompleteState:
    """Saves, restores, resets and compares the state of a run. Loop thread, between two ticks.

    A run continues bit for bit from a restored state, as long as it gets the same inputs.
    Parameters are settings and not part of the state. A restored or reset state is published at
    once, so that it is visible even while time stands still. A state is restored into the model
    that it was saved with. `clock` publishes a time to which the clock is set.

    Attributes:
        input_gate: notes restored states and resets while a run is recorded.
    """

    input_gate: InputGate | None = None

    def __init__(
        self,
        simulation: Physics,
        managers: Sequence[ControllerManager],
        clock: ClockPublisher | None = None,
    ) -> None:
        self._simulation = simulation
        self._managers = tuple(managers)
        self._schedules: list[FrameSchedule] = []
        self._clock = clock or SilentClock()

    def add_schedule(self, schedule: FrameSchedule) -> None:
        """Count the rates of cameras or sensors as state; without any, a state has none."""
        self._schedules.append(schedule)

    @property
    def time_s(self) -> float:
        """Simulation time."""
        return self._simulation.time_s

    def save(self) -> bytes:
        """Return the state.

        Raises:
            StateError: something cannot be saved; the message names all such controllers.
        """
        return encode(
            {
                "simulation": self._simulation.save_state(),
                "managers": [manager.state.save() for manager in self._managers],
                "schedules": [schedule.save_state() for schedule in self._schedules],
            }
        )

    def check(self, saved: bytes) -> dict[str, Any]:
        """Return a saved state's content, if it fits these robots and their controllers.

        The model is not checked; the caller that restores the state must provide the right one.

        Raises:
            StateError: it does not fit; the message says what differs.
        """
        state = decode(saved)
        count, present = len(state["managers"]), len(self._managers)
        if count != present:
            raise StateError(
                f"the snapshot has {count} robots with controllers; this run has {present}"
            )
        for manager, saved_manager in zip(self._managers, state["managers"], strict=True):
            manager.state.check(saved_manager)
        feeds = [len(rates) for _, _, rates in state["schedules"]]
        # A program without ROS draws and reads on demand, so its state has no schedules.
        if self._schedules and feeds and feeds != [len(schedule) for schedule in self._schedules]:
            raise StateError("the snapshot was made with other cameras or sensors")
        return state

    @run_input
    def restore(self, saved: bytes) -> None:
        """Restore a saved state, life cycles and clock included.

        Goals that it does not have are aborted. A goal that it has continues; if its client has
        already received a result, the motion continues without a client.

        Raises:
            StateError: it does not fit, or a controller or component refuses its transition.
        """
        state = self.check(saved)
        # Transitions of life cycles set modes and commands, so they come first.
        for manager, saved_manager in zip(self._managers, state["managers"], strict=True):
            manager.state.align(saved_manager)
        self._simulation.load_state(state["simulation"])
        self._load_controllers(state)
        for schedule, saved_schedule in zip_longest(self._schedules, state["schedules"]):
            if saved_schedule is None:
                schedule.restart()
            elif schedule is not None:
                schedule.load_state(saved_schedule)
        self._show()
        # Publishing the state has run the broadcasters once more.
        self._load_controllers(state)

    @run_input
    def reset(self, clock: bool) -> None:
        """Return physics, drives, controllers and noise to their start.

        Controllers stay active. Their goals are aborted, and their set-points are read again. With
        `clock` the clock starts at 0 again; otherwise it continues.

        Raises:
            StateError: some controllers refuse; everything else is reset.
        """
        self._simulation.reset(0.0 if clock else self._simulation.time_s)
        for schedule in self._schedules:
            schedule.restart()
        refused: list[str] = []
        for manager in self._managers:
            manager.updates.clear()
            try:
                manager.state.reset()
            except StateError as error:
                refused.append(str(error))
        self._show()
        for manager in self._managers:
            manager.state.restart_cadences()
        if refused:
            raise StateError("; ".join(refused))

    @run_input
    def set_clock(self, time_s: float) -> None:
        """Set the clock; nothing else changes."""
        self._simulation.set_clock(time_s)
        for schedule in self._schedules:
            schedule.restart()
        self._clock.publish(time_s)

    def fingerprint(self) -> Iterator[tuple[str, bytes]]:
        """Yield the parts of the state by name: bytes that differ if the state does.

        It takes some microseconds, where `save` takes some hundred.
        """
        yield from self._simulation.fingerprint()
        for number, manager in enumerate(self._managers):
            for part, content in manager.state.fingerprint():
                yield f"{number}/{part}" if number else part, content

    def digest(self) -> bytes:
        """Return a hash of the state."""
        return blake2b(
            b"".join([content for _, content in self.fingerprint()]), digest_size=DIGEST_BYTES
        ).digest()

    def _load_controllers(self, state: Mapping[str, Any]) -> None:
        for manager, saved in zip(self._managers, state["managers"], strict=True):
            manager.state.load(saved)

    def _show(self) -> None:
        """Publish the time and the states."""
        time_s = self._simulation.time_s
        self._clock.publish(time_s)
        for manager in self._managers:
            manager.publish(time_s, self._simulation.timing.period_s)
