"""A snapshot: the complete state of a run, the world that it needs, and what it was made with."""

from collections.abc import Mapping
from dataclasses import dataclass
from hashlib import blake2b
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import zstandard

from arm_control.errors import StateError
from arm_control.state.encoding import decode, encode
from arm_gazebo.state.made_with import machine_differences
from arm_gazebo.world.changes import Spawned, WorldChanges
from arm_gazebo.world.refusal import Refusal, RequestError
from arm_gazebo.world.spawn_model import ModelSource

SUFFIX = ".snapshot"
MAGIC = b"arm snapshot 1\n"
HASH_BYTES = 16
LEVEL = 3
"""Compression level: higher ones take ten times as long and save a few per cent."""
MAX_BYTES = 1 << 31


@dataclass(frozen=True, slots=True)
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
    if theirs != mujoco.__version__:
        raise RequestError(
            Refusal.UNREADABLE,
            f"{path} was made with MuJoCo {theirs}, and this is {mujoco.__version__}: its state "
            "does not fit",
        )
    return content


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
