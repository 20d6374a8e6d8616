"""A pool of a cluster whose head goes in the middle of a call of Ray."""

from pathlib import Path
from threading import Event, Thread
from types import SimpleNamespace

import pytest

from arm_sim.sweep import ray_pool
from arm_sim.sweep.ray_pool import RayPool


class Cluster:
    """Stands for Ray, whose calls wait for a head that has gone; here until the test answers."""

    def __init__(self) -> None:
        self.asked, self.answers = Event(), Event()

    def cluster_resources(self) -> dict[str, float]:
        self.asked.set()
        self.answers.wait(60.0)
        return {"CPU": 3.0}


@pytest.fixture
def cluster(monkeypatch) -> Cluster:
    made = Cluster()
    head = SimpleNamespace(check=lambda: None, answers=lambda: True)
    monkeypatch.setattr(ray_pool, "join", lambda *_: "127.0.0.1:1")
    monkeypatch.setattr(ray_pool, "HeadWatch", lambda _: head)
    monkeypatch.setattr(ray_pool.ray, "cluster_resources", made.cluster_resources)
    return made


def test_the_size_never_waits_for_the_head(cluster, tmp_path):
    study = SimpleNamespace(task="task.py:run", seed=0)
    pool = RayPool("127.0.0.1:1", study, Path(tmp_path))  # pyright: ignore[reportArgumentType]
    assert pool.size() == 0
    assert cluster.asked.wait(60.0)
    assert pool.size() == 0
    cluster.answers.set()
    sizing: Thread = pool._sizing
    sizing.join(60.0)
    assert pool.size() == 3
