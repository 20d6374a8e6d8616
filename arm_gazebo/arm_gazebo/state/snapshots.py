"""Snapshots of a running simulation, by name or in files: what they are, to save and restore."""

from collections.abc import Callable, Mapping
from hashlib import blake2b
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import zstandard

from arm_control.errors import StateError
from arm_control.state.encoding import decode, encode
from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.state.complete_state import CompleteState
from arm_gazebo.state.made_with import machine_differences, made_with
from arm_gazebo.world.changes import Spawned, WorldChanges
from arm_gazebo.world.editor import WorldEditor
from arm_gazebo.world.entity import NAME
from arm_gazebo.world.spawn_model import ModelSource
from arm_node.frozen import frozen
from arm_node.names import describe_known

SUFFIX = ".snapshot"
MAGIC = b"arm snapshot 1\n"
HASH_BYTES = 16
LEVEL = 3
"""Compression level: higher ones take ten times as long and save a few per cent."""
MAX_BYTES = 1 << 31


@frozen
class RunSnapshot:
    """One moment of a run.

    Attributes:
        time_s: its simulation time.
        world: name of its world.
        model: hash of its model, see `model_hash`.
        changes: what was spawned, deleted and moved in the world.
        made_with: versions and machine, see `made_with`.
        state: see `CompleteState.save`.
    """

    time_s: float
    world: str
    model: str
    changes: WorldChanges
    made_with: Mapping[str, str]
    state: bytes

    @property
    def description(self) -> str:
        """The moment in a few words."""
        things = [spawned.name for spawned in self.changes.spawned]
        more = f", with {', '.join(things)}" if things else ""
        return f"{self.time_s:.3f} s in the world {self.world}{more}"


def write_snapshot(path: Path, snapshot: RunSnapshot) -> None:
    """Write a snapshot to a file, whole or not at all.

    Raises:
        RequestError: it cannot be written.
    """
    changes = snapshot.changes
    content = encode(
        {
            "time_s": snapshot.time_s,
            "world": snapshot.world,
            "model": snapshot.model,
            "made_with": dict(snapshot.made_with),
            "removed": changes.removed,
            "moved": dict(changes.moved),
            "spawned": [(s.name, s.model.uri, s.model.text, s.pose) for s in changes.spawned],
            "state": snapshot.state,
        }
    )
    beside = path.with_name(f"{path.name}.part")
    try:
        beside.write_bytes(MAGIC + zstandard.compress(content, LEVEL))
        beside.replace(path)
    except OSError as error:
        raise RequestError(Refusal.FAILED, f"cannot write {path}: {error.strerror}") from error


def read_snapshot(path: Path, source: ModelSource) -> RunSnapshot:
    """Read a snapshot from a file; models that were spawned are read from theirs.

    Raises:
        RequestError: it does not exist, is not a snapshot, or does not fit this MuJoCo.
    """
    content = _content_of(path)
    try:
        spawned = tuple(
            Spawned(name, source.read(uri, text), pose)
            for name, uri, text, pose in content["spawned"]
        )
        return RunSnapshot(
            time_s=content["time_s"],
            world=content["world"],
            model=content["model"],
            changes=WorldChanges(content["removed"], spawned, content["moved"]),
            made_with=content["made_with"],
            state=content["state"],
        )
    except (KeyError, TypeError, ValueError) as error:
        raise _damaged(path, error) from error


def _content_of(path: Path) -> Any:
    try:
        with path.open("rb") as file:
            if file.read(len(MAGIC)) != MAGIC:
                raise RequestError(Refusal.UNREADABLE, f"{path} is not a snapshot of arm sim save")
            compressed = file.read()
    except OSError as error:
        raise RequestError(Refusal.NO_RESOURCE, f"cannot read {path}: {error.strerror}") from error
    try:
        content = decode(zstandard.decompress(compressed, MAX_BYTES))
        made_with = content["made_with"]
    except (zstandard.ZstdError, StateError, KeyError, TypeError) as error:
        raise _damaged(path, error) from error
    theirs = made_with.get("mujoco", "")
    if _release(theirs) != _release(mujoco.__version__):
        raise RequestError(
            Refusal.UNREADABLE,
            f"{path} was made with MuJoCo {theirs}, and this is {mujoco.__version__}: its state "
            "does not fit",
        )
    return content


def _release(version: str) -> str:
    """Return a version without its last number: patch releases of MuJoCo have the same arrays."""
    return version.rpartition(".")[0]


def _damaged(path: Path, error: Exception) -> RequestError:
    return RequestError(Refusal.UNREADABLE, f"{path} is damaged: {error}")


def machine_remark(snapshot: RunSnapshot) -> str:
    """Return how this machine differs from the snapshot's, "" if a run continues bit for bit."""
    others = machine_differences(snapshot.made_with)
    if not others:
        return ""
    return f"made with {', '.join(others)}: the run may continue with other rounding errors"


def model_hash(model: mujoco.MjModel) -> str:
    """Return a hash of a model that no simulation has tuned, equal for equal models.

    Names of files are left out: they depend on the machine, and their contents count.
    """
    found = blake2b(digest_size=HASH_BYTES)
    for name in dir(model):
        if name.startswith("_") or name == "paths":
            continue
        value = getattr(model, name)
        if isinstance(value, np.ndarray):
            found.update(f"{name} {value.dtype.str} {value.shape}".encode())
            found.update(value.tobytes())
        elif isinstance(value, (int, float, bytes)):
            found.update(f"{name} {value!r}".encode())
    for name in dir(model.opt):
        if not name.startswith("_") and not callable(getattr(model.opt, name)):
            found.update(f"{name} {getattr(model.opt, name)!r}".encode())
    return found.hexdigest()


class SnapshotStore:
    """The snapshots of a running simulation. One thread other than the loop's.

    A snapshot with a name lasts as long as the simulation. A path, which has a slash or ends with
    ".snapshot", is a file. `world` returns the name of the present world. `on_restore` is called on
    the loop thread after each restore, to restart the figures.
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
            theirs = snapshot.made_with.get("mujoco")
            versions = (
                ""
                if theirs == mujoco.__version__
                else f"; MuJoCo {theirs} may also have built it otherwise than {mujoco.__version__}"
            )
            raise RequestError(
                Refusal.FAILED,
                f"the model of the snapshot '{where}' is not that of this simulation: it was made "
                f"in the world {snapshot.world}, and this is {self._world()}; its robots, their "
                "arguments and the files of spawned models must be the same as well" + versions,
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
