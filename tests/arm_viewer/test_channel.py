"""The page's own WebSocket, with plain sockets in place of browsers."""

import asyncio
import contextlib
import json
from typing import Any

import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection
from websockets.sync.client import connect as connect_within

from arm_viewer.access import LOCAL_HOST as HOST
from arm_viewer.channel import MAX_UNSENT_BYTES, PATH
from arm_viewer.errors import BrowserMessageError
from arm_viewer.page_server import page_server

TIMEOUT_S = 30.0


def connect(address: str, **options: Any) -> ClientConnection:
    """Open a WebSocket on a machine that may be busy."""
    return connect_within(address, open_timeout=TIMEOUT_S, **options)


@pytest.fixture(scope="module")
def server():
    with page_server(port=0) as running:
        running.channel.on("echo", lambda message, browser: browser.send("echo", {"ok": True}))
        yield running


@pytest.fixture
def join(server):
    """Connect browsers, which leave with the test."""
    with contextlib.ExitStack() as joined:

        def arrive():
            address = f"ws://{HOST}:{server.get_port()}{PATH}"
            return joined.enter_context(connect(address, origin=server.url, max_size=None))

        yield arrive


def in_loop(server, work):
    """Run a function in viser's event loop, where the channel is used."""

    async def run():
        return work()

    loop = server.get_event_loop()
    return asyncio.run_coroutine_threadsafe(run(), loop).result(TIMEOUT_S)


def read(browser):
    return json.loads(browser.recv(TIMEOUT_S))


def ask(browser, **fields):
    browser.send(json.dumps(fields))
    return read(browser)


def test_a_handler_answers_the_browser_that_asked(server, join):
    first, second = join(), join()
    assert ask(first, kind="echo") == {"kind": "echo", "ok": True}
    server.channel.on("name", lambda message, browser: browser.send("name", {"it": "second"}))
    assert ask(second, kind="name") == {"kind": "name", "it": "second"}
    assert ask(first, kind="echo") == {"kind": "echo", "ok": True}


def test_a_message_to_all_reaches_every_browser(server, join):
    browsers = [join(), join()]
    for browser in browsers:
        ask(browser, kind="echo")
    in_loop(server, lambda: server.channel.send("time", {"time_s": 1.5}))
    assert [read(browser) for browser in browsers] == [{"kind": "time", "time_s": 1.5}] * 2


def test_a_browser_that_comes_later_gets_the_newest_of_what_is_kept(join):
    with page_server(port=0) as server:
        for number in range(2):
            in_loop(server, lambda n=number: server.channel.send("state", {"number": n}, keep=True))
        in_loop(server, lambda: server.channel.send("event", {}))
        server.channel.on("echo", lambda message, browser: browser.send("echo", {}))
        with connect(f"ws://{HOST}:{server.get_port()}{PATH}") as browser:
            assert read(browser) == {"kind": "state", "number": 1}
            assert ask(browser, kind="echo") == {"kind": "echo"}


def test_binary_frames_start_with_their_kind(server, join):
    browser = join()
    ask(browser, kind="echo")
    in_loop(server, lambda: server.channel.send_bytes(7, b"poses"))
    assert browser.recv(TIMEOUT_S) == b"\x07poses"


def test_a_browser_that_is_behind_misses_binary_frames_but_no_message(server, join):
    behind = join()
    ask(behind, kind="echo")

    def send():
        # More than the sockets of both ends hold.
        for number in range(200):
            server.channel.send_bytes(1, bytes([number]) * MAX_UNSENT_BYTES)
        server.channel.send("last", {})

    in_loop(server, send)
    frames = []
    while not frames or isinstance(frames[-1], bytes):
        frames.append(behind.recv(TIMEOUT_S))
    assert json.loads(frames[-1]) == {"kind": "last"}
    assert 0 < len(frames) - 1 < 200
    in_loop(server, lambda: server.channel.send_bytes(1, b"again"))
    assert behind.recv(TIMEOUT_S) == b"\x01again"


@pytest.mark.parametrize(
    ("frame", "problem"),
    [
        ("", "is not JSON"),
        (b"\xff", "is not JSON"),
        ("[" * 60_000, "is not JSON"),
        ("[]", "is not a JSON object with a 'kind'"),
        ('{"kind": 1}', "is not a JSON object with a 'kind'"),
        ('{"kind": "nothing"}', "does not serve 'nothing'"),
        (json.dumps({"kind": "echo", "text": "a" * 100_000}), "at most 65536"),
    ],
)
def test_what_cannot_be_read_is_refused_with_a_sentence(join, frame, problem):
    browser = join()
    browser.send(frame)
    answer = read(browser)
    assert answer["kind"] == "refused"
    assert problem in answer["problem"]
    assert ask(browser, kind="echo") == {"kind": "echo", "ok": True}


def test_a_handler_that_fails_ends_no_connection(server, join, caplog):
    def fail(message, browser):
        raise ZeroDivisionError("nobody expects it")

    server.channel.on("fail", fail)
    browser = join()
    assert "its log says why" in ask(browser, kind="fail", number=3)["problem"]
    assert "nobody expects it" in caplog.text
    assert ask(browser, kind="echo") == {"kind": "echo", "ok": True}


def test_a_handlers_own_sentence_reaches_the_browser(server, join):
    def refuse(message, browser):
        raise BrowserMessageError("there is no simulation")

    server.channel.on("pause", refuse)
    answer = ask(join(), kind="pause", number=3)
    assert answer == {
        "kind": "refused",
        "of": "pause",
        "number": 3,
        "problem": "there is no simulation",
    }


@pytest.mark.parametrize(
    ("accessor", "value"),
    [
        ("number", None),
        ("number", "1"),
        ("number", True),
        ("number", [1]),
        ("number", 10**400),
        ("text", 5),
        ("text", "a" * 1000),
        ("flag", 1),
        ("flag", "true"),
    ],
)
def test_a_field_of_another_type_is_refused(server, join, accessor, value):
    taken = []
    server.channel.on(
        "field", lambda message, browser: taken.append(getattr(message, accessor)("x"))
    )
    assert "'x' of 'field' is" in ask(join(), kind="field", x=value)["problem"]
    assert not taken


def test_a_number_that_json_does_not_have_is_refused(server, join):
    server.channel.on("field", lambda message, browser: message.number("x"))
    browser = join()
    browser.send('{"kind": "field", "x": NaN}')
    assert "is not a finite number" in read(browser)["problem"]


def test_a_foreign_page_is_refused(server):
    with (
        pytest.raises(InvalidStatus),
        connect(f"ws://{HOST}:{server.get_port()}{PATH}", origin="http://evil.example"),
    ):
        pytest.fail("it was accepted")
