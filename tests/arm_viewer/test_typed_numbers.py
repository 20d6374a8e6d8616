"""Numbers that are typed beside sliders: what they say, and the WebSocket by which they come."""

import json

import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from arm_viewer.page_server import HOST, page_server
from arm_viewer.typed_numbers import PATH, number_typed


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
    server.take_typed_number = lambda slider, text: taken.append((slider, text)) or ""
    with connect(f"ws://{HOST}:{server.get_port()}{PATH}", origin=server.url) as page:
        for number, text in enumerate(("-0.5", "1e-2")):
            page.send(json.dumps({"number": number, "slider": "s", "text": text}))
        answers = [json.loads(page.recv(30.0)) for _ in range(2)]
    assert answers == [{"number": 0, "problem": ""}, {"number": 1, "problem": ""}]
    assert taken == [("s", "-0.5"), ("s", "1e-2")]


@pytest.mark.parametrize(
    "message", ["", "[]", "[" * 100_000, '{"number": 1}', b"\xff", '{"slider": 1, "text": "1"}']
)
def test_something_else_is_answered_and_moves_nothing(server, message):
    taken = []
    server.take_typed_number = lambda slider, text: taken.append(text) or ""
    with connect(f"ws://{HOST}:{server.get_port()}{PATH}") as program:
        program.send(message)
        assert json.loads(program.recv(30.0))["problem"]
    assert not taken


def test_numbers_of_a_foreign_page_are_refused(server):
    with (
        pytest.raises(InvalidStatus),
        connect(f"ws://{HOST}:{server.get_port()}{PATH}", origin="http://evil.example"),
    ):
        pytest.fail("it was accepted")
