"""Snapshots by name and in files: over spawns and deletions, refused where they do not fit."""

from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
from robots import crate

from arm_control.errors import StateError
from arm_control.state.encoding import decode, encode
from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.state.snapshots import (
    MAGIC,
    SnapshotStore,
    model_hash,
    read_snapshot,
    write_snapshot,
)
from arm_gazebo.world.editor import SpawnRequest, WorldEditor
from arm_gazebo.world.spawn_model import ModelSource

CRATE = crate()
PATCH = f"{mujoco.__version__.rpartition('.')[0]}.99"
"""Another patch release of the MuJoCo in use."""


class Kept:
    """A running robot with its world editor and its snapshots; the loop is called at once."""

    def __init__(self, robot) -> None:
        self.robot = robot
        source = ModelSource(robot.simulation.timing.step_s)
        self.editor = WorldEditor(robot.simulation, lambda f: f(), robot.hardware, [], source)
        self.restored = 0
        self.snapshots = SnapshotStore(robot.state, self.editor, lambda: "table", self._count)

    def _count(self) -> None:
        self.restored += 1

    def spawn(self, name: str, x: float, uri: str = "") -> None:
        pose = np.eye(4)
        pose[:3, 3] = x, 0.3, 0.4
        self.editor.spawn(SpawnRequest(name, uri, "" if uri else CRATE, pose))

    def names(self) -> list[str]:
        return sorted(entity.name for entity in self.editor.entities)


@pytest.fixture
def kept(arm):
    """Return a maker of kept arms in the world of the pick."""

    def make(**more) -> Kept:
        return Kept(arm("pick_and_place_demo", **more))

    return make


def refusal(action) -> tuple[Refusal, str]:
    with pytest.raises(RequestError) as caught:
        action()
    return caught.value.refusal, str(caught.value)


def test_a_run_goes_on_from_a_name_as_it_did(kept):
    run = kept()
    run.robot.move(1.0, 0.6, -0.5, 0.4)
    run.robot.run(40)
    assert run.snapshots.save("before").description == "0.400 s in the world table"
    first = run.robot.run(80)
    snapshot, remark = run.snapshots.restore("before")
    assert (snapshot.time_s, remark, run.restored) == (0.4, "", 1)
    assert run.robot.run(80) == first


def test_things_that_came_since_go_and_things_that_went_return(kept):
    run = kept()
    run.spawn("kept", 0.4)
    run.robot.run(30)
    names = run.names()
    run.snapshots.save("a")
    first = run.robot.run(60)
    run.spawn("more", 0.6)
    run.editor.delete("kept")
    run.editor.delete("red_cylinder")
    run.robot.run(20)
    run.snapshots.restore("a")
    assert run.names() == names
    assert run.robot.run(60) == first


def test_a_file_is_restored_by_another_simulation(kept, tmp_path):
    run, other = kept(), kept()
    run.spawn("crate", 0.4)
    run.robot.move(1.0, 0.6, -0.5, 0.4)
    run.robot.run(40)
    file = tmp_path / "a.snapshot"
    run.snapshots.save(str(file))
    assert file.read_bytes().startswith(MAGIC)
    other.robot.run(7)
    other.snapshots.restore(str(file))
    assert other.names() == run.names()
    assert other.robot.run(80) == run.robot.run(80)
    other.spawn("another", 0.7)
    other.robot.run(5)


def test_a_model_file_that_has_changed_since_is_refused(kept, tmp_path):
    model = tmp_path / "crate.urdf"
    model.write_text(CRATE)
    run = kept()
    run.spawn("crate", 0.4, str(model))
    run.snapshots.save(str(tmp_path / "a.snapshot"))
    run.snapshots.restore(str(tmp_path / "a.snapshot"))
    model.write_text(CRATE.replace("mass value='1'", "mass value='2'"))
    kind, message = refusal(lambda: run.snapshots.restore(str(tmp_path / "a.snapshot")))
    assert kind is Refusal.FAILED
    assert "is not that of this simulation" in message


def test_a_snapshot_of_another_world_is_refused_and_changes_nothing(kept, arm, tmp_path):
    file = str(tmp_path / "a.snapshot")
    kept().snapshots.save(file)
    other = Kept(arm("objects"))
    other.robot.run(5)
    before = other.robot.state.save()
    kind, message = refusal(lambda: other.snapshots.restore(file))
    assert kind is Refusal.FAILED
    assert "in the world table" in message
    assert other.robot.state.save() == before


@pytest.mark.parametrize(
    ("content", "words"),
    [(b"", "is not a snapshot of arm sim save"), (b"arm snapshot 1\nnonsense", "is damaged")],
)
def test_other_files_are_refused(kept, tmp_path, content, words):
    file = tmp_path / "a.snapshot"
    file.write_bytes(content)
    kind, message = refusal(lambda: kept().snapshots.restore(str(file)))
    assert kind is Refusal.UNREADABLE
    assert words in message


def test_a_file_that_is_cut_off_is_refused(kept, tmp_path):
    file = tmp_path / "a.snapshot"
    run = kept()
    run.snapshots.save(str(file))
    file.write_bytes(file.read_bytes()[:-100])
    assert refusal(lambda: run.snapshots.restore(str(file)))[0] is Refusal.UNREADABLE


def test_another_version_of_mujoco_is_refused(kept, tmp_path):
    file = tmp_path / "a.snapshot"
    run = kept()
    saved = run.snapshots.save("a")
    write_snapshot(file, replace(saved, made_with={**saved.made_with, "mujoco": "3.0"}))
    _, message = refusal(lambda: run.snapshots.restore(str(file)))
    assert "was made with MuJoCo 3.0" in message


def test_another_patch_release_of_mujoco_is_a_remark(kept, tmp_path):
    file = tmp_path / "a.snapshot"
    run = kept()
    saved = run.snapshots.save("a")
    made_with = {**saved.made_with, "mujoco": PATCH}
    write_snapshot(file, replace(saved, made_with=made_with))
    _, remark = run.snapshots.restore(str(file))
    assert f"made with mujoco {PATCH} (here {mujoco.__version__})" in remark
    write_snapshot(file, replace(saved, made_with=made_with, model="of another one"))
    _, message = refusal(lambda: run.snapshots.restore(str(file)))
    assert f"MuJoCo {PATCH} may also have built it otherwise than {mujoco.__version__}" in message


@pytest.mark.parametrize("part", ["model", "arrays"])
@pytest.mark.parametrize("name", ["dof_M0", "qpos", "none_such"])
def test_arrays_that_mujoco_does_not_have_here_are_refused(kept, part, name):
    run = kept()
    run.snapshots.save("a")
    saved = run.snapshots.named()["a"]
    state = decode(saved.state)
    state["simulation"]["physics"][part][name] = np.zeros(3)
    position = run.robot.simulation.data.qpos.copy()
    with pytest.raises(StateError, match=f"array {name} does not fit this model in MuJoCo"):
        run.robot.state.restore(encode(state))
    assert np.array_equal(run.robot.simulation.data.qpos, position)


def test_another_machine_is_a_remark(kept, tmp_path):
    file = tmp_path / "a.snapshot"
    run = kept()
    saved = run.snapshots.save("a")
    write_snapshot(file, replace(saved, made_with={**saved.made_with, "machine": "riscv"}))
    _, remark = run.snapshots.restore(str(file))
    assert "machine riscv" in remark


def test_names_are_listed_and_removed(kept):
    run = kept()
    run.snapshots.save("a")
    run.snapshots.save("b")
    assert list(run.snapshots.named()) == ["a", "b"]
    run.snapshots.remove("a")
    assert list(run.snapshots.named()) == ["b"]
    kind, message = refusal(lambda: run.snapshots.restore("a"))
    assert (kind, message) == (Refusal.NO_RESOURCE, "no snapshot 'a'; there is b")
    assert refusal(lambda: run.snapshots.save("no name"))[0] is Refusal.NAME_INVALID


def test_only_snapshots_are_deleted(kept, tmp_path):
    run = kept()
    file, other = tmp_path / "a.snapshot", tmp_path / "thesis.txt"
    run.snapshots.save(str(file))
    other.write_text("years of work")
    assert refusal(lambda: run.snapshots.remove(str(other)))[0] is Refusal.UNREADABLE
    run.snapshots.remove(str(file))
    assert (file.exists(), other.exists()) == (False, True)


def test_a_file_that_cannot_be_written_or_read_is_named(kept, tmp_path):
    run = kept()
    assert "No such file" in refusal(lambda: run.snapshots.save(str(tmp_path / "no" / "a")))[1]
    assert "No such file" in refusal(lambda: run.snapshots.restore(str(tmp_path / "b.snapshot")))[1]


def test_a_file_keeps_every_number(kept, tmp_path):
    run = kept()
    run.spawn("crate", 0.4)
    run.editor.delete("coke_can")
    saved = run.snapshots.save("a")
    file = Path(tmp_path / "a.snapshot")
    write_snapshot(file, saved)
    again = read_snapshot(file, ModelSource(run.robot.simulation.timing.step_s))
    assert (again.time_s, again.model, again.state) == (saved.time_s, saved.model, saved.state)
    assert again.changes.removed == saved.changes.removed
    assert np.array_equal(again.changes.spawned[0].pose, saved.changes.spawned[0].pose)


def test_equal_models_have_equal_hashes_and_others_do_not(kept):
    one, other = kept(), kept()
    hashes = [model_hash(run.editor.model_with(run.editor.changes).model) for run in (one, other)]
    assert hashes[0] == hashes[1]
    one.spawn("crate", 0.4)
    assert model_hash(one.editor.model_with(one.editor.changes).model) != hashes[0]
