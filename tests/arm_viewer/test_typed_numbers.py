"""Numbers that are typed beside sliders: what they say, and how they come through the channel."""

import json

import pytest
from websockets.sync.client import connect

from arm_viewer.access import LOCAL_HOST as HOST
from arm_viewer.channel import PATH
from arm_viewer.page_server import page_server
from arm_viewer.typed_numbers import KIND, number_typed, typed_number_handler


@pytest.mark.parametrize(
    ("text", "number"), [("-0.5", -0.5), ("1e-2", 0.01), (" 0.12345 ", 0.12345), ("-1", -1.0)]
)
def test_a_number_is_what_was_typed(text, number):
    assert number_typed(text, "j0", -1.0, 1.0) == number


def test_a_number_beyond_a_limit_by_rounding_is_the_limit():
    assert number_typed("-1e-20", "j0", 0.0, 1.0) == 0.0
    assert number_typed("1.0000000001", "j0", 0.0, 1.0) == 1.0


@pytest.mark.parametrize("text", ["", "-", "0,5", "1e", "half"])
def test_an_invalid_number_is_reported(text):
    with pytest.raises(ValueError, match="is not a number"):
        number_typed(text, "j0", -1.0, 1.0)


@pytest.mark.parametrize("text", ["1.01", "-inf", "nan"])
def test_an_unreachable_position_is_reported(text):
    with pytest.raises(ValueError, match="'j0' goes from -1 to 1"):
        number_typed(text, "j0", -1.0, 1.0)


@pytest.fixture(scope="module")
def server():
    with page_server(port=0) as running:
        yield running


def test_every_number_is_answered_in_turn(server):
    taken = []
    server.channel.on(KIND, typed_number_handler(lambda *typed: taken.append(typed) or "no"))
    with connect(f"ws://{HOST}:{server.get_port()}{PATH}", origin=server.url) as page:
        for number, text in enumerate(("-0.5", "1e-2")):
            page.send(json.dumps({"kind": KIND, "number": number, "slider": "s", "text": text}))
        answers = [json.loads(page.recv(30.0)) for _ in range(2)]
    assert answers == [{"kind": KIND, "number": n, "problem": "no"} for n in (0, 1)]
    assert taken == [("s", "-0.5"), ("s", "1e-2")]


@pytest.mark.parametrize(
    "fields", [{}, {"slider": 1, "text": "1"}, {"slider": "s", "text": "1" * 1000}]
)
def test_a_message_that_is_not_a_typed_number_moves_nothing(server, fields):
    taken = []
    server.channel.on(KIND, typed_number_handler(lambda *typed: taken.append(typed) or ""))
    with connect(f"ws://{HOST}:{server.get_port()}{PATH}") as program:
        program.send(json.dumps({"kind": KIND, "number": 7, **fields}))
        answer = json.loads(program.recv(30.0))
    assert (answer["kind"], answer["of"], answer["number"]) == ("refused", KIND, 7)
    assert "is not a text" in answer["problem"]
    assert not taken
