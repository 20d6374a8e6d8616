"""An MJCF is tried in a separate process, whose failure becomes a sentence."""

import gc
import os
import signal

import psutil
import pytest

from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.mjcf.memory_limit import MemoryLimit
from arm_gazebo.world.spawn_model import ModelSource
from arm_gazebo.world.trial import MjcfTrial

LIMIT = MemoryLimit(100.0, "p")
GOOD = "<mujoco><worldbody><body><geom size='.1'/></body></worldbody></mujoco>"
FIELD = (
    "<mujoco><asset><hfield name='h' nrow='2000' ncol='2000' size='1 1 1 1'/></asset>"
    "<worldbody><body><geom type='hfield' hfield='h'/></body></worldbody></mujoco>"
)


@pytest.fixture(scope="module")
def trial():
    return MjcfTrial()


def newest_child():
    """The child process that started last: other tests keep trial processes of their own."""
    return max(psutil.Process().children(), key=lambda process: process.create_time())


def test_a_good_model_has_no_problem(trial):
    assert trial.problem(GOOD, None, LIMIT) == ""


def test_a_file_is_read_in_place(trial, tmp_path):
    (tmp_path / "part.xml").write_text("<mujocoinclude><geom size='.1'/></mujocoinclude>")
    file = tmp_path / "a.xml"
    file.write_text(GOOD.replace("<geom size='.1'/>", "<include file='part.xml'/>"))
    assert trial.problem("", file, LIMIT) == ""


def test_the_problem_is_mujocos_message(trial):
    assert "unrecognized attribute: 'siz'" in trial.problem(
        GOOD.replace("size", "siz"), None, LIMIT
    )


def test_memory_over_the_limit_is_a_sentence(trial):
    assert trial.problem(FIELD, None, MemoryLimit(200.0, "p")) == ""
    message = "it needs more than 10 MB (parameter p)"
    assert trial.problem(FIELD, None, MemoryLimit(10.0, "p")) == message


def test_a_process_that_was_killed_is_started_again():
    trial = MjcfTrial()
    trial.problem(GOOD, None, LIMIT)
    before = newest_child()
    os.kill(before.pid, signal.SIGKILL)
    before.wait()
    assert trial.problem(GOOD, None, LIMIT) == ""
    assert newest_child().pid != before.pid


def test_the_process_ends_with_its_owner():
    mine = MjcfTrial()
    mine.problem(GOOD, None, LIMIT)
    pid = newest_child().pid
    del mine
    gc.collect()
    assert not psutil.pid_exists(pid)


def test_a_spawn_over_the_limit_is_refused_as_unreadable():
    with pytest.raises(RequestError, match="needs about 80 MB") as caught:
        ModelSource(0.002, memory_limit=MemoryLimit(50.0, "p")).read("", FIELD)
    assert caught.value.refusal is Refusal.UNREADABLE


def test_an_mjcf_that_names_a_fifo_is_not_spawned(tmp_path):
    os.mkfifo(tmp_path / "fifo.stl")
    file = tmp_path / "a.xml"
    file.write_text('<mujoco><asset><mesh name="m" file="fifo.stl"/></asset></mujoco>')
    with pytest.raises(RequestError, match="it is a FIFO") as caught:
        ModelSource(0.002).read(str(file), "")
    assert caught.value.refusal is Refusal.UNREADABLE


@pytest.mark.parametrize("kind", ["fifo", "device"])
def test_what_is_not_a_regular_file_is_not_spawned(tmp_path, kind):
    os.mkfifo(tmp_path / "fifo")
    uri = str(tmp_path / "fifo") if kind == "fifo" else "/dev/zero"
    with pytest.raises(RequestError, match="not a regular file") as caught:
        ModelSource(0.002).read(uri, "")
    assert caught.value.refusal is Refusal.NO_RESOURCE
