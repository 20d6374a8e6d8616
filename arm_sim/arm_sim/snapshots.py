"""Saves a simulation, and restores a saved state bit for bit."""

import logging
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from arm_control.errors import StateError
from arm_sim.assembly import SimulationParts
from arm_sim.errors import CallError
from arm_sim.goals import Goal
from arm_sim.robots import AnyPath

if TYPE_CHECKING:
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

    Attributes:
        seed: the present seed of the noise.
    """

    def __init__(self, parts: SimulationParts) -> None:
        """Remember the state at the start, if every controller can be saved."""
        self._parts = parts
        self.seed = parts.settings.seed
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
            self._parts.physics.time_s,
            self._parts.state.save(),
            self._parts.world_changes,
            self.seed,
            self._parts.controllers.running_goals(),
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
            self._parts.controllers.restore_goals({})
            return
        if snapshot.owner is not self:
            raise CallError("the snapshot was saved by another simulation")
        self._check_seed(snapshot.seed)
        self._parts.state.check(snapshot.state)
        self._parts.change_world(snapshot.world)
        self._parts.state.restore(snapshot.state)
        self._parts.controllers.restore_goals(snapshot.goals)
        self._reseed(snapshot.seed)

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
            self._reseed(seed)

    @cached_property
    def _files(self) -> "SnapshotStore":
        """The snapshots in files, which the node's services read and write as well."""
        from arm_gazebo.state.snapshots import SnapshotStore

        things = self._parts.things
        return SnapshotStore(
            self._parts.state,
            things.editor,
            lambda function: function(),
            things.source,
            lambda: self._parts.world_name,
            lambda: None,
        )

    def _check_seed(self, seed: int) -> None:
        if seed != self.seed and self._parts.physics.input_gate is not None:
            raise CallError("a run that is being recorded keeps its seed")

    def _reseed(self, seed: int) -> None:
        if seed == self.seed:
            return
        self.seed = seed
        self._parts.reseed(seed)


def _absolute(path: AnyPath) -> str:
    # The store takes a word without a slash as a name.
    return str(Path(path).expanduser().absolute())
