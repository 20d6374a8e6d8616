"""Saves a simulation, and restores a saved state bit for bit."""

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from arm_control.errors import StateError
from arm_sim.controllers import Controllers
from arm_sim.errors import CallError
from arm_sim.goals import Goal
from arm_sim.robots import AnyPath

if TYPE_CHECKING:
    from arm_gazebo.run.run import SimulationRun
    from arm_gazebo.state.snapshots import SnapshotStore
    from arm_gazebo.world.changes import WorldChanges

logger = logging.getLogger("arm_sim")


@dataclass(frozen=True, slots=True, eq=False)
class SavedState:
    """A state of one simulation; `Simulation.restore` goes back to it any number of times.

    Attributes:
        time_s: simulation time of the state.
        state: physics, drives and controllers.
        world: the changes to the world since it was built; None for none.
        seed: seed of the noise.
        goals: the running goals, by controller and number.
        owner: the `Snapshots` that saved it.
    """

    time_s: float
    state: bytes
    world: "WorldChanges | None"
    seed: int
    goals: Mapping[str, Mapping[int, Goal[Any]]]
    owner: "Snapshots"


class Snapshots:
    """Saves and restores a simulation between two ticks.

    `reseed` gives sensors and cameras the noise of another run.
    """

    def __init__(
        self, run: "SimulationRun", controllers: Controllers, reseed: Callable[[int], None]
    ) -> None:
        """Remember the state at the start, if every controller can be saved."""
        self._run = run
        self._controllers = controllers
        self._reseed = reseed
        self._start: SavedState | StateError
        try:
            self._start = self.save()
        except StateError as error:
            self._start = error

    def save(self, path: AnyPath | None = None) -> SavedState:
        """Return the present state, and write it to a file if one is given.

        Raises:
            StateError, RequestError: a controller cannot be saved, or the file cannot be written.
        """
        if path is not None:
            self._files.save(_absolute(path))
        return SavedState(
            self._run.physics.time_s,
            self._run.state.save(),
            self._run.changes,
            self._run.seed,
            self._controllers.running_goals(),
            self,
        )

    def restore(self, snapshot: SavedState | AnyPath) -> None:
        """Go back to a state, or to that of a file.

        Raises:
            StateError, RequestError: it does not fit, or the file cannot be read.
            CallError: it was saved by another simulation.
        """
        if not isinstance(snapshot, SavedState):
            _, remark = self._files.restore(_absolute(snapshot))
            if remark:
                logger.warning("%s: %s", snapshot, remark)
            self._controllers.restore_goals({})
            return
        if snapshot.owner is not self:
            raise CallError("the snapshot was saved by another simulation")
        self._check_seed(snapshot.seed)
        self._run.state.check(snapshot.state)
        if snapshot.world is not self._run.changes:
            from arm_gazebo.world.changes import NOTHING

            self._run.editor.change_to(snapshot.world or NOTHING)
        self._run.state.restore(snapshot.state)
        self._controllers.restore_goals(snapshot.goals)
        self._change_seed(snapshot.seed)

    def reset(self, seed: int | None) -> None:
        """Go back to the start; with a seed, to that of a simulation with this seed.

        Raises:
            StateError: a controller cannot be saved, or is not loaded any more.
        """
        if isinstance(self._start, StateError):
            raise self._start
        if seed is not None:
            self._check_seed(seed)
        self.restore(self._start)
        if seed is not None:
            self._change_seed(seed)

    @cached_property
    def _files(self) -> "SnapshotStore":
        """The snapshots in files, which the node's services read and write as well."""
        from arm_gazebo.state.snapshots import SnapshotStore

        run = self._run
        return SnapshotStore(run.state, run.editor, lambda: run.world_name, lambda: None)

    def _check_seed(self, seed: int) -> None:
        if seed != self._run.seed and self._run.physics.input_gate is not None:
            raise CallError("a run that is being recorded keeps its seed")

    def _change_seed(self, seed: int) -> None:
        if seed != self._run.seed:
            self._reseed(seed)


def _absolute(path: AnyPath) -> str:
    # The store takes a word without a slash as a name.
    return str(Path(path).expanduser().absolute())
