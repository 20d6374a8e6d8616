"""Demonstrations of the pick as a dataset: equal bits, and no failure among the successes."""

import json
from collections.abc import Iterator
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

from arm_sim.demonstrations import (
    Demonstration,
    DemonstrationError,
    PickDemonstrator,
    record_demonstrations,
)


@pytest.fixture(scope="module")
def short() -> Iterator[PickDemonstrator]:
    """A demonstrator of beginnings, with pictures."""
    demonstrator = PickDemonstrator(frames=4)
    yield demonstrator
    demonstrator.close()


def done(shown: Demonstration) -> "Future[Demonstration]":
    made: Future[Demonstration] = Future()
    made.set_result(shown)
    return made


def files_of(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


@pytest.mark.gl
def test_equal_seeds_give_equal_files(short, tmp_path):
    def start(seed: int) -> "Future[Demonstration]":
        return done(replace(short.make(seed), failure=""))

    for name in ("one", "two"):
        record_demonstrations(tmp_path / name, 2, start, seed=5)
    one, two = (files_of(tmp_path / name) for name in ("one", "two"))
    assert sum(name.endswith(".mp4") for name in one) == 2
    assert one == two
    rows = pq.read_table(tmp_path / "one/data/chunk-000/file-000.parquet")
    states = np.array(rows["observation.state"].to_pylist())
    assert np.abs(states[0] - states[4]).max() > 0.01, "each seed has its own start"


@pytest.mark.gl
def test_light_and_views_differ_from_seed_to_seed(short):
    one, two = (short.make(seed) for seed in (1, 3))
    for name, image in one.images.items():
        assert image.shape == (4, 240, 320, 3)
        assert np.abs(image[0].mean() - two.images[name][0].mean()) > 1.0
    assert one.scene["mass_kg"] != two.scene["mass_kg"]
    assert one.failure == "the cylinder is not up at the end"


def test_the_expert_lifts_the_cylinder_or_says_why_it_cannot():
    demonstrator = PickDemonstrator(cameras=())
    shown = [demonstrator.make(seed) for seed in (0, 1, 2)]
    demonstrator.close()
    *lifted, blocked = shown
    assert [one.failure for one in lifted] == ["", ""]
    assert blocked.failure.startswith("no plan: the arm cannot grip at")
    for one in lifted:
        assert one.surroundings[-1, 2] - one.surroundings[0, 2] > one.surroundings[0, 3] - 0.01
        assert np.abs(np.diff(one.commands, axis=0)).max() < 0.112, "an action's longest step"


def empty(seed: int, failure: str) -> Demonstration:
    rows = np.zeros((3, 1), np.float32)
    around = np.zeros((3, 4), np.float32)
    return Demonstration(seed, failure, {}, ("j0",), rows, around, rows, {}, 0.5)


def test_failures_are_left_out_and_counted(tmp_path):
    said: list[str] = []
    recorded = record_demonstrations(
        tmp_path / "data",
        2,
        lambda seed: done(empty(seed, "no plan: too far" if seed == 8 else "")),
        seed=7,
        ahead=4,
        say=said.append,
    )
    assert recorded.failures == {8: "no plan: too far"}
    assert recorded.processor_s >= 0.75
    assert said == [
        "seed 7: episode 1 of 2",
        "seed 8: left out, no plan: too far",
        "seed 9: episode 2 of 2",
    ]
    told = json.loads((tmp_path / "data/meta/arm_suite.json").read_text())
    assert [one["source"]["seed"] for one in told["episodes"]] == [7, 9]


def test_it_ends_early_with_the_episodes_so_far(tmp_path):
    said: list[str] = []

    def has_said_three() -> bool:
        return len(said) == 3

    def fails_first(seed: int) -> "Future[Demonstration]":
        return done(empty(seed, "" if seed else "no plan: too far"))

    recorded = record_demonstrations(
        tmp_path / "data", 9, fails_first, say=said.append, enough=has_said_three
    )
    assert said == [
        "seed 0: left out, no plan: too far",
        "seed 1: episode 1 of 9",
        "seed 2: episode 2 of 9",
    ]
    assert recorded.episodes == 2
    assert recorded.processor_s >= 0.75
    assert len(json.loads((tmp_path / "data/meta/arm_suite.json").read_text())["episodes"]) == 2


def test_an_expert_that_always_fails_ends(tmp_path):
    with pytest.raises(DemonstrationError, match=r"failed in 11 episodes.*of seed 10: no plan"):
        record_demonstrations(tmp_path / "data", 2, lambda seed: done(empty(seed, "no plan")))
    assert list(tmp_path.iterdir()) == []
