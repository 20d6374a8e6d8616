"""The states of joints over time."""

import pytest

from arm_sim.bench.history import FIRST_CAPACITY, StateHistory


def history_of(rows: int) -> StateHistory:
    history = StateHistory(["a", "b"], ["rad", "m"])
    for row in range(rows):
        history.add(0.1 * row, [row, -row], [1.0, 2.0], [3.0, 4.0])
    return history


def test_each_quantity_has_a_row_for_each_time():
    history = history_of(3)
    assert history.times_s.tolist() == pytest.approx([0.0, 0.1, 0.2])
    assert history.position.tolist() == [[0, 0], [1, -1], [2, -2]]
    assert history.velocity.tolist() == [[1, 2]] * 3
    assert history.effort.tolist() == [[3, 4]] * 3


def test_it_grows():
    count = 2 * FIRST_CAPACITY + 1
    history = history_of(count)
    assert len(history) == count
    assert history.position[:, 0].tolist() == list(range(count))


def test_what_it_shows_cannot_be_changed_but_it_still_takes_states():
    history = history_of(1)
    with pytest.raises(ValueError, match="read-only"):
        history.position[0, 0] = 9.0
    history.add(0.1, [7.0, 8.0], [0.0, 0.0], [0.0, 0.0])
    assert history.position[1].tolist() == [7.0, 8.0]


@pytest.mark.parametrize(
    ("joint", "quantity", "unit"),
    [
        ("a", "position", "rad"),
        ("b", "velocity", "m/s"),
        ("a", "effort", "N m"),
        ("b", "effort", "N"),
    ],
)
def test_units(joint, quantity, unit):
    assert history_of(0).unit(joint, quantity) == unit
