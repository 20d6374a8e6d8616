"""What keys and a gamepad ask a jog for."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_cli.teleop.motions import (
    TIP_KEYS,
    JointMotion,
    Keyboard,
    TipMotion,
    gamepad_motion,
    keys_of,
)

AXES = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0]
HELD = [0, 0, 0, 0, 1]


@pytest.mark.parametrize(
    ("typed", "keys"),
    [
        ("1q", ["1", "q"]),
        ("\x1b[A\x1b[B\x1b[C\x1b[D", ["up", "down", "right", "left"]),
        ("\x1bOA.", ["up", "."]),
        ("\x1b[1;5A", ["up"]),
        ("\x1b[3~x\x1b[", ["x"]),
        ("\x1b", ["\x1b"]),
    ],
)
def test_arrows_are_keys_and_other_escape_sequences_are_none(typed, keys):
    assert keys_of(typed) == keys


@given(st.text("\x1b[O;15AD~q. ", max_size=12))
def test_whatever_is_typed_is_read_to_its_end(typed):
    assert len(keys_of(typed)) <= len(typed)


def test_keys_move_the_tip_and_joints_at_the_speed_that_is_set():
    keyboard = Keyboard(["base", "elbow"])
    assert keyboard.press("left") == TipMotion((0.0, 0.5, 0.0))
    assert keyboard.press("Z") == TipMotion(angular=(0.0, 0.0, -0.5))
    assert keyboard.press("2") == JointMotion("elbow", 0.5)
    assert [keyboard.press(key) for key in ("3", "0", "r", "+", "?", "²")] == [None] * 6
    assert keyboard.press("1") == JointMotion("base", -0.6)
    assert keyboard.describe() == "speed 60%, axes of the world, joints reversed"


def test_the_speed_stays_between_a_tenth_and_all():
    keyboard = Keyboard([])
    for key, speed in (("-", 0.1), ("+", 1.0)):
        for _ in range(12):
            keyboard.press(key)
        assert keyboard.speed == speed


def test_axes_are_those_of_the_world_or_of_the_end_effector():
    keyboard = Keyboard([])
    keyboard.press("e")
    assert keyboard.in_tip_frame
    keyboard.press("w")
    assert not keyboard.in_tip_frame


def test_keys_of_the_tip_cancel_each_other():
    opposite = {motion.scaled(-1.0) for motion in TIP_KEYS.values()}
    assert opposite == set(TIP_KEYS.values())


def test_a_gamepad_moves_only_while_its_left_shoulder_button_is_held():
    pushed = [0.5, -1.0, 1.0, 0.02, 0.25, 1.0, -1.0, 0.0]
    assert gamepad_motion(pushed, [0, 0, 0, 0, 0]) is None
    assert gamepad_motion(pushed, HELD) == TipMotion((-1.0, 0.5, 0.25), (1.0, 0.0, 0.0))


def test_triggers_and_sticks_at_rest_do_not_move():
    assert gamepad_motion(AXES, HELD) == TipMotion()


@pytest.mark.parametrize(
    ("axes", "buttons", "message"),
    [
        ([0.0] * 4, HELD, "the gamepad has 4 axes and 5 buttons; 8 and 5 are read"),
        (AXES, [1], "8 axes and 1 buttons"),
        ([math.nan, *AXES[1:]], HELD, "not finite"),
    ],
)
def test_a_gamepad_that_cannot_be_read_is_said(axes, buttons, message):
    with pytest.raises(ValueError, match=message):
        gamepad_motion(axes, buttons)
