"""The picture of joints over time."""

from math import nan, sin
from pathlib import Path

import cv2
import numpy as np

from arm_sim.bench.history import ReferenceLine, StateHistory
from arm_sim.bench.joint_plot import COLOURS, save_plot
from arm_sim.injected_faults import FaultSpan


def picture_of(history: StateHistory, path: Path, faults=()) -> np.ndarray:
    save_plot(history, path, faults)
    picture = cv2.imread(str(path))
    assert picture is not None
    return picture


def history_of(values: list[float]) -> StateHistory:
    history = StateHistory(["a"], ["rad"])
    for index, value in enumerate(values):
        history.add(0.01 * index, [value], [0.0], [0.0])
    return history


def pixels(picture: np.ndarray, colour: tuple[int, int, int]) -> int:
    return int(near(picture, colour).sum())


def near(picture: np.ndarray, colour: tuple[int, int, int]) -> np.ndarray:
    """Where the first panel has nearly this colour: lines have soft edges."""
    return (np.abs(picture[:240].astype(int) - colour) < 60).all(axis=2)


def test_a_joint_is_drawn_in_its_colour(tmp_path):
    picture = picture_of(history_of([sin(0.05 * i) for i in range(200)]), tmp_path / "a.png")
    assert pixels(picture, COLOURS[0]) > 200
    assert pixels(picture, COLOURS[1]) == 0


def test_a_value_that_was_expected_is_drawn_as_well(tmp_path):
    history = history_of([0.0] * 50)
    before = pixels(picture_of(history, tmp_path / "a.png"), COLOURS[0])
    history.guides.append(ReferenceLine("position", "a", 1.0))
    assert pixels(picture_of(history, tmp_path / "b.png"), COLOURS[0]) > before + 100


def test_a_fault_is_shaded(tmp_path):
    history = history_of([0.0] * 50)
    plain = picture_of(history, tmp_path / "a.png")
    shaded = picture_of(history, tmp_path / "b.png", [FaultSpan("j0 stalled", 0.1, 0.3)])
    assert int((plain != shaded).any(axis=2).sum()) > 10_000


def test_values_that_are_not_numbers_leave_a_gap(tmp_path):
    picture = picture_of(history_of([0.0] * 50 + [nan] * 50 + [0.0] * 50), tmp_path / "a.png")
    columns = near(picture, COLOURS[0]).any(axis=0)
    assert columns[200]
    assert not columns[450]
    assert columns[700]


def test_one_state_alone_can_be_drawn(tmp_path):
    assert picture_of(history_of([nan]), tmp_path / "a.png").shape[2] == 3
