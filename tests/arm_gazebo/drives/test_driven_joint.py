from itertools import pairwise

import pytest

from arm_gazebo.drives.driven_joint import CommandStream

PERIOD_S = 0.01


@pytest.fixture
def stream():
    return CommandStream(0.0, PERIOD_S)


def test_single_command_is_a_step(stream):
    stream.command(1.0, tick=100)
    stream.advance()
    assert (stream.target, stream.velocity) == (1.0, 0.0)


def test_command_that_is_repeated_changes_nothing(stream):
    for tick in range(100, 110):
        stream.command(0.0, tick)
        stream.advance()
    assert (stream.target, stream.velocity) == (0.0, 0.0)


def test_commands_of_every_tick_are_a_motion(stream):
    for tick in range(100, 110):
        stream.command(0.01 * (tick - 99), tick)
        stream.advance()
    assert stream.target == pytest.approx(0.1)
    assert stream.velocity == pytest.approx(1.0)


def test_slower_commands_are_joined_by_straight_lines(stream):
    targets = []
    for tick in range(100, 130):
        if tick % 3 == 0:
            stream.command(0.03 * (tick - 99) / 3, tick)
        stream.advance()
        targets.append(stream.target)
    steps = [b - a for a, b in pairwise(targets[10:])]
    assert steps == pytest.approx([0.01] * len(steps))


def test_motion_ends_at_the_last_command(stream):
    for tick in (100, 101, 102):
        stream.command(0.01 * (tick - 99), tick)
        stream.advance()
    stream.advance()
    assert (stream.target, stream.velocity) == (pytest.approx(0.03), 0.0)


def test_command_after_a_pause_is_a_step_again(stream):
    stream.command(0.1, tick=100)
    stream.advance()
    stream.command(0.5, tick=110)
    stream.advance()
    assert (stream.target, stream.velocity) == (0.5, 0.0)
