"""Save and restore snapshots of a running simulation, by name or in files."""

from collections.abc import Callable
from pathlib import Path

from arm_control.errors import StateError
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.state.complete_state import CompleteState
from arm_gazebo.state.made_with import made_with
from arm_gazebo.state.snapshot import (
    SUFFIX,
    RunSnapshot,
    machine_remark,
    model_hash,
    read_snapshot,
    write_snapshot,
)
from arm_gazebo.world.changes import WorldChanges
from arm_gazebo.world.editor import WorldEditor
from arm_gazebo.world.entity import NAME
from arm_gazebo.world.refusal import Refusal, RequestError
from arm_node.names import describe_known


class SnapshotStore:
    """The snapshots of a running simulation. One thread other than the loop's.

    A snapshot with a name lasts as long as the simulation. A path, which has a slash or ends with
    ".snapshot", is a file.

    Args:
        state: the state of the run, which belongs to the loop.
        editor: the world.
        world: returns the name of the present world.
        on_restore: called on the loop thread after each restore, to restart the figures.
    """

    def __init__(
        self,
        state: CompleteState,
        editor: WorldEditor,
        world: Callable[[], str],
        on_restore: Callable[[], None],
    ) -> None:
        self._state = state
        self._editor = editor
        self._world = world
        self._on_restore = on_restore
        self._named: dict[str, RunSnapshot] = {}
        self._hashed: tuple[BuiltModel, WorldChanges, str] | None = None

    def save(self, where: str) -> RunSnapshot:
        """Save the present state under a name, which may be taken, or to a file.

        Raises:
            RequestError: a controller cannot be saved, the name is invalid, or the file cannot be
                written.
        """
        path = _path_of(where)
        if path is None and not NAME.fullmatch(where):
            raise RequestError(
                Refusal.NAME_INVALID,
                f"{where[:120]!r} is not a name: it takes 1 to 100 letters, digits and _ . -; "
                f"a file has a slash or ends with {SUFFIX}",
            )
        changes = self._editor.changes
        try:
            time_s, state = self._editor.on_loop(lambda: (self._state.time_s, self._state.save()))
        except StateError as error:
            raise RequestError(Refusal.FAILED, str(error)) from error
        model = self._hash_of(changes)
        snapshot = RunSnapshot(time_s, self._world(), model, changes, made_with(), state)
        if path is None:
            self._named[where] = snapshot
        else:
            write_snapshot(path, snapshot)
        return snapshot

    def restore(self, where: str) -> tuple[RunSnapshot, str]:
        """Continue from a snapshot, before the next tick.

        Returns:
            The snapshot, and a remark about it, "" for none.

        Raises:
            RequestError: there is none, or it does not fit this simulation; nothing has changed.
                Or a controller refused its transition.
        """
        path = _path_of(where)
        snapshot = self._find(where) if path is None else read_snapshot(path, self._editor.source)
        self._check(where, snapshot)
        refused: list[str] = []

        def restore() -> None:
            try:
                self._state.restore(snapshot.state)
            except StateError as error:
                # Not raised here: the world has changed, and the editor must know its model.
                refused.append(str(error))
            self._on_restore()

        self._editor.change_to(snapshot.changes, restore)
        if refused:
            raise RequestError(Refusal.FAILED, "; ".join(refused))
        return snapshot, machine_remark(snapshot)

    def remove(self, where: str) -> None:
        """Forget a snapshot, or delete its file.

        Raises:
            RequestError: there is none.
        """
        path = _path_of(where)
        if path is None:
            self._find(where)
            del self._named[where]
            return
        # Only a snapshot is deleted.
        read_snapshot(path, self._editor.source)
        path.unlink(missing_ok=True)

    def named(self) -> dict[str, RunSnapshot]:
        """Return the snapshots with names."""
        return dict(self._named)

    def _find(self, name: str) -> RunSnapshot:
        if name not in self._named:
            raise RequestError(
                Refusal.NO_RESOURCE,
                f"no snapshot '{name}'; {describe_known(name, self._named)}",
            )
        return self._named[name]

    def _check(self, where: str, snapshot: RunSnapshot) -> None:
        """Check that a snapshot fits, before anything changes."""
        if self._hash_of(snapshot.changes) != snapshot.model:
            raise RequestError(
                Refusal.FAILED,
                f"the model of the snapshot '{where}' is not that of this simulation: it was made "
                f"in the world {snapshot.world}, and this is {self._world()}; its robots, their "
                "arguments and the files of spawned models must be the same as well",
            )
        try:
            self._editor.on_loop(lambda: self._state.check(snapshot.state))
        except StateError as error:
            raise RequestError(Refusal.FAILED, str(error)) from error

    def _hash_of(self, changes: WorldChanges) -> str:
        """Return the hash of the present world with these changes."""
        base, hashed = self._editor.base, self._hashed
        if hashed is not None and hashed[0] is base and hashed[1] is changes:
            return hashed[2]
        # A simulation tunes its model, so the hash is that of a newly built one.
        found = model_hash(self._editor.model_with(changes).model)
        self._hashed = base, changes, found
        return found


def _path_of(where: str) -> Path | None:
    """Return the path of a file; None for a name."""
    is_file = "/" in where or where.endswith(SUFFIX)
    return Path(where).expanduser().absolute() if is_file else None
