"""The codec of Feetech's frames, and its reader on streams that hold anything."""

import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_drivers.feetech.frames import (
    Alarm,
    ReplyCollector,
    read_request,
    sync_read_request,
    sync_write_request,
    write_request,
)

IDS = (1, 2, 3)
REQUEST = sync_read_request(IDS, 56, 2)


def reply(servo: int, data: bytes, error: int = 0) -> bytes:
    """A frame by the protocol's definition, written here once more."""
    body = bytes((servo, len(data) + 2, error)) + data
    return b"\xff\xff" + body + bytes((255 - sum(body) % 256,))


def collected(stream: bytes, request: bytes = REQUEST, ids: tuple[int, ...] = IDS) -> dict:
    collector = ReplyCollector(request, ids, 2)
    collector.take(stream)
    return {servo: each.data for servo, each in collector.replies().items()}


def true_data(servo: int) -> bytes:
    return bytes((servo, 7))


TRUE = {servo: true_data(servo) for servo in IDS}
CLEAN = b"".join(reply(servo, data) for servo, data in TRUE.items())


@pytest.mark.parametrize(
    ("frame", "wanted"),
    [
        (read_request(1, 56, 2), "ff ff 01 04 02 38 02 be"),
        (write_request(1, 40, b"\x01"), "ff ff 01 04 03 28 01 ce"),
        (sync_read_request((1, 2), 56, 2), "ff ff fe 06 82 38 02 01 02 3c"),
        (
            sync_write_request(42, {1: b"\x00\x08", 2: b"\x00\x04"}),
            "ff ff fe 0a 83 2a 02 01 00 08 02 00 04 39",
        ),
    ],
)
def test_a_request_is_a_frame_with_its_checksum(frame, wanted):
    assert frame == bytes.fromhex(wanted)


def test_replies_are_taken_with_their_alarms_but_not_that_the_torque_is_on():
    collector = ReplyCollector(REQUEST, (1,), 2)
    collector.take(reply(1, b"\x00\x08", error=0b110001))
    assert collector.is_complete
    assert collector.replies()[1].alarm == Alarm.VOLTAGE | Alarm.OVERLOAD


@pytest.mark.parametrize(
    ("stream", "ids"),
    [
        (CLEAN, {1, 2, 3}),
        (REQUEST + CLEAN, {1, 2, 3}),
        (b"\xff\xff\xff\x00" + CLEAN, {1, 2, 3}),
        (reply(1, true_data(1)) * 2 + CLEAN[8:], {1, 2, 3}),
        (CLEAN[8:], {2, 3}),
        (b"\xff\xff\x01\x04" + CLEAN, {1, 2, 3}),
        (reply(3, b"\x99\x99") + CLEAN, {1, 2, 3}),
        (reply(2, b"\x99\x99") + CLEAN, {1, 2, 3}),
        (reply(1, b"\x99\x99") + CLEAN, {2, 3}),
        (reply(1, b"\x05") + CLEAN[8:], {2, 3}),
        (reply(1, b"\x05\x05\x05") + CLEAN[8:], {2, 3}),
        (reply(7, b"\x05\x05") + CLEAN[8:], {2, 3}),
        (CLEAN[:5] + b"\x00" + CLEAN[6:], {2, 3}),
    ],
    ids=[
        *(
            "clean",
            "echo",
            "noise",
            "header",
            "doubled",
            "lost",
            "late_last",
            "late_middle",
            "late_first",
        ),
        *("short", "long", "foreign", "damaged"),
    ],
)
def test_a_fault_costs_at_most_its_own_reply(stream, ids):
    assert collected(stream) == {servo: TRUE[servo] for servo in ids}


@given(st.binary(max_size=200), st.lists(st.integers(1, 9), max_size=40))
def test_no_stream_of_bytes_has_a_wrong_value_or_costs_the_next_request(noise, sizes):
    collector = ReplyCollector(REQUEST, IDS, 2)
    stream = noise
    for size in sizes:
        collector.take(stream[:size])
        stream = stream[size:]
    collector.take(stream)
    assert collector.replies() == {}
    assert collected(CLEAN) == TRUE


def test_no_mixture_of_faults_has_a_wrong_value():
    chance = random.Random(1)
    others = [CLEAN, REQUEST, reply(9, b"ab"), reply(1, b"a"), reply(2, b"abc")]
    complete = 0
    for _ in range(2000):
        stream = bytearray(b"".join(chance.choices(others, k=3)) + CLEAN)
        stream[chance.randrange(len(stream))] ^= chance.choice((0, 1, 16))
        del stream[: chance.randrange(9)]
        found = collected(bytes(stream))
        assert found.items() <= TRUE.items()
        complete += found == TRUE
    assert complete > 1000
