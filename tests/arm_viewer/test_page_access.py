"""A page for other machines: its token, and that a read-only browser commands nothing.

Plain sockets stand for browsers, so that they can send whatever a modified browser would.
"""

import http.client
import io
import json
import os
import queue
from collections.abc import Iterator
from contextlib import contextmanager

import msgspec
import pytest
import viser
import zstandard
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection, connect

from arm_viewer.access import Access
from arm_viewer.arm_viewer_node import invitation
from arm_viewer.channel import PATH, READ_ONLY
from arm_viewer.errors import PageError
from arm_viewer.page import page_running
from arm_viewer.page_server import page_server
from arm_viewer.requests import (
    AddFile,
    AddThing,
    Request,
    SetEmergencyStop,
    SetPlaying,
    SetSpeed,
    ShowPictures,
    Watch,
)
from arm_viewer.snapshot import RunStatus, Snapshot

TIMEOUT_S = 30.0
LENGTHS = 16
"""Bytes before the messages of a frame of viser."""
CAMERA = {
    "type": "ViewerCameraMessage",
    "wxyz": (1.0, 0.0, 0.0, 0.0),
    "position": (1.0, 2.0, 3.0),
    "fov": 1.0,
    "near": 0.1,
    "far": 10.0,
    "look_at": (0.0, 0.0, 0.0),
    "up_direction": (0.0, 0.0, 1.0),
    "image_height": 100,
    "image_width": 100,
}
FILE = {"name": "a.stl", "size": 1, "offset": 0, "data": "eA=="}
"""A whole file of one byte."""


class Page:
    """A running page on all addresses, and the requests that it passes on to ROS."""

    def __init__(self, server) -> None:
        self.server = server
        self.host = f"127.0.0.1:{server.get_port()}"
        self.requests: queue.SimpleQueue[Request] = queue.SimpleQueue()
        self.arrivals: queue.SimpleQueue[viser.ClientHandle] = queue.SimpleQueue()
        server.on_client_connect(self.arrivals.put)

    def send(self, request: Request) -> None:
        # Which pictures are received, and how often, is the page's own matter.
        if not isinstance(request, Watch | ShowPictures):
            self.requests.put(request)

    def get(self, path, **headers):
        connection = http.client.HTTPConnection(self.host, timeout=TIMEOUT_S)
        connection.request("GET", path, headers=headers)
        response = connection.getresponse()
        text = response.read().decode()
        connection.close()
        return response, text

    def cookie(self, token):
        return f"arm_page_{self.server.get_port()}={token}"

    @contextmanager
    def socket(self, token, path="/") -> Iterator[ClientConnection]:
        """Open a WebSocket as a browser does that has the page's cookie."""
        protocols = [] if path == PATH else [f"viser-v{viser.__version__}"]
        with connect(
            f"ws://{self.host}{path}",
            origin=f"http://{self.host}",
            subprotocols=protocols or None,
            additional_headers={"Cookie": self.cookie(token)},
            max_size=None,
            max_queue=None,
            open_timeout=TIMEOUT_S,
        ) as opened:
            yield opened

    def forge(self, token, messages) -> None:
        """Send messages to viser, and return when it has read them."""
        with self.socket(token) as browser:
            browser.send(msgspec.msgpack.encode(CAMERA))
            moved = queue.SimpleQueue()
            self.arrivals.get(timeout=TIMEOUT_S).camera.on_update(moved.put)
            for message in [*messages, CAMERA | {"position": (3.0, 2.0, 1.0)}]:
                browser.send(msgspec.msgpack.encode(message))
            moved.get(timeout=TIMEOUT_S)


@pytest.fixture(scope="module")
def page():
    with page_server(0, access=Access.on("0.0.0.0")) as server:
        page = Page(server)
        # The commands of the palette act only while there is a simulation.
        snapshot = Snapshot(stops={"": False}, run=RunStatus("paused", 1.0, ()))
        with page_running(server, lambda: snapshot, page.send):
            yield page


def forged_messages(page):
    """Return an update of each element of the page, and each command of the palette."""
    messages = []
    with page.socket(page.server.access.read_only_token) as browser:
        browser.send(msgspec.msgpack.encode(CAMERA))
        while not any(m["type"] == "ReplayDoneMessage" for m in messages):
            frame = browser.recv(TIMEOUT_S)
            unpacked = zstandard.ZstdDecompressor().decompressobj().decompress(frame[LENGTHS:])
            messages += msgspec.msgpack.decode(unpacked)["messages"]
        page.arrivals.get(timeout=TIMEOUT_S)
    for message in messages:
        if message["type"] == "RegisterCommandMessage":
            yield {"type": "CommandTriggerMessage", "uuid": message["uuid"]}
        elif message["type"] in ("GuiCheckboxMessage", "GuiButtonMessage"):
            yield {"type": "GuiUpdateMessage", "uuid": message["uuid"], "updates": {"value": True}}


def test_without_the_token_nothing_is_served(page):
    for path in ("/", "/?token=guessed", "/channel", "/anything.js"):
        response, text = page.get(path)
        assert response.status == 401
        assert "`arm view` printed" in text
    for path in ("/", PATH):
        with pytest.raises(InvalidStatus) as refused, page.socket("guessed", path):
            pass
        assert refused.value.response.status_code == 401


def test_the_address_with_the_token_becomes_a_cookie_and_an_address_without(page):
    token = page.server.access.token
    response, _ = page.get(f"/?fixedDpr=1&token={token}")
    assert response.status == 303
    assert response.headers["Location"] == "/?fixedDpr=1"
    kept = response.headers["Set-Cookie"]
    assert kept == f"{page.cookie(token)}; Path=/; HttpOnly; SameSite=Lax"
    response, text = page.get("/", Cookie=kept.partition(";")[0])
    assert response.status == 200
    assert "arm-stop" in text
    assert 'id = "arm-read-only"' not in text


def test_the_page_of_a_read_only_browser_says_so(page):
    _, text = page.get("/", Cookie=page.cookie(page.server.access.read_only_token))
    assert 'id = "arm-read-only"' in text


def test_a_foreign_origin_is_refused_with_the_token_too(page):
    cookie = page.cookie(page.server.access.token)
    response, text = page.get("/", Cookie=cookie, Origin="http://evil.example")
    assert response.status == 403
    assert "evil.example" in text


def test_no_message_of_a_read_only_browser_commands_anything(page):
    access = page.server.access
    forged = list(forged_messages(page))
    assert len(forged) > 10
    page.forge(access.read_only_token, forged)
    with page.socket(access.read_only_token, PATH) as browser:
        kinds = ("run", "emergency_stop", "typed_number", "file_part", "choose_thing", "nothing")
        for kind in kinds:
            fields = {"do": "play", "engaged": True, "number": 1, **FILE}
            browser.send(json.dumps({"kind": kind, **fields}))
        refused = []
        while len(refused) < len(kinds):
            answer = json.loads(browser.recv(TIMEOUT_S))
            refused += [answer] * (answer["kind"] == "refused")
    assert [answer["problem"] for answer in refused[:5]] == [READ_ONLY] * 5
    assert page.requests.empty()
    # The same messages command the robot when they come from a browser that may.
    page.forge(access.token, forged)
    with page.socket(access.token, PATH) as browser:
        browser.send(json.dumps({"kind": "run", "do": "play"}))
        browser.send(json.dumps({"kind": "file_part", **FILE}))
        wanted = {SetEmergencyStop, SetPlaying, SetSpeed, AddThing, AddFile}
        while wanted:
            wanted.discard(type(page.requests.get(timeout=TIMEOUT_S)))
    assert not wanted


def test_what_only_its_own_browser_shows_is_served_to_a_read_only_one(page):
    page.server.channel.on(
        "look", lambda message, browser: browser.send("look", {"ok": True}), changes=False
    )
    with page.socket(page.server.access.read_only_token, PATH) as browser:
        browser.send(json.dumps({"kind": "look"}))
        kinds = []
        while kinds[-1:] != ["look"]:
            kinds.append(json.loads(browser.recv(TIMEOUT_S))["kind"])
    assert "refused" not in kinds


class Terminal(io.StringIO):
    """Stands for a terminal."""

    def isatty(self):
        return True


def test_the_invitation_has_both_addresses_and_in_a_terminal_a_code(page, monkeypatch):
    access = page.server.access
    text = invitation(page.server, io.StringIO())
    first, second = text.splitlines()
    assert first.endswith(f"/?token={access.token}")
    assert second.endswith(f"/?token={access.read_only_token}")
    for columns, drawn in ((80, True), (20, False)):
        size = os.terminal_size((columns, 24))
        monkeypatch.setattr("os.get_terminal_size", lambda _, size=size: size)
        monkeypatch.setattr(Terminal, "fileno", lambda self: 1)
        assert ("\u2580" in invitation(page.server, Terminal())) is drawn


def test_an_address_of_another_machine_is_a_sentence():
    for host in ("192.0.2.1", "no such name"):
        with (
            pytest.raises(PageError, match="is not an address of this machine"),
            page_server(0, access=Access.on(host)),
        ):
            pass
