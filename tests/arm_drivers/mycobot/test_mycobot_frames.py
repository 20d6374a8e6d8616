"""The codec of the myCobot's frames, and its reader on streams that hold anything."""

import math
import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_drivers.mycobot.frames import (
    MyCobotCommand,
    angles_of,
    angles_request,
    reply_data,
    request,
)

ANGLES = bytes.fromhex("2328 0000 ff9c 0001 0000 0000")
REPLY = b"\xfe\xfe\x0e\x20" + ANGLES + b"\xfa"


def test_requests_are_frames():
    assert request(MyCobotCommand.READ_ANGLES) == bytes.fromhex("fefe 02 20 fa")
    wanted = "fefe 0f 22 2328 0000 ff9c 0000 0000 0000 32 fa"
    assert angles_request([math.pi / 2, 0, math.radians(-1), 0, 0, 0], 50) == bytes.fromhex(wanted)


def test_angles_are_read_in_rad():
    data = reply_data(REPLY, MyCobotCommand.READ_ANGLES)
    assert data is not None
    assert angles_of(data)[:3] == pytest.approx((math.pi / 2, 0.0, math.radians(-1)))


@pytest.mark.parametrize(
    "before",
    [
        b"",
        b"\xfe",
        b"\xfe\xfe\x0e",
        bytes.fromhex("fefe 03 22 01 fa"),
        bytes.fromhex("fefe 0d 20") + ANGLES[:-1] + b"\xfa",
        REPLY[:-1] + b"\x00",
    ],
    ids=["clean", "noise", "header", "acknowledgement", "short", "without_end"],
)
def test_a_fault_before_a_reply_is_skipped(before):
    assert reply_data(before + REPLY, MyCobotCommand.READ_ANGLES) == ANGLES


@given(st.binary(max_size=200).filter(lambda noise: b"\xfe\xfe" not in noise))
def test_noise_is_no_reply_and_does_not_cost_the_next_one(noise):
    found = reply_data(noise + REPLY, MyCobotCommand.READ_ANGLES)
    assert reply_data(noise, MyCobotCommand.READ_ANGLES) is None
    assert found == ANGLES


def test_no_mixture_of_other_frames_is_a_reply():
    chance = random.Random(1)
    others = [bytes.fromhex(text) for text in ("fefe0322 01fa", "fefe0265fa", "fefe0365 64fa")]
    others += [REPLY[:-3] + b"\xfa", b"\xfa\xfe"]
    for _ in range(2000):
        stream = b"".join(chance.choices(others, k=4))
        assert reply_data(stream, MyCobotCommand.READ_ANGLES) is None
        assert reply_data(stream + REPLY, MyCobotCommand.READ_ANGLES) == ANGLES
