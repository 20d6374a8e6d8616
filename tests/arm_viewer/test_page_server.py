"""The page's server, tested with plain sockets."""

import http.client
import logging
import queue
import socket
from collections import deque
from types import SimpleNamespace

import pytest
import viser
import viser.infra._infra
import websockets
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from arm_viewer.access import LOCAL_HOST as HOST
from arm_viewer.channel import PATH
from arm_viewer.errors import PageError
from arm_viewer.page_server import PageServer, page_server

TIMEOUT_S = 30.0
FOREIGN = "http://evil.example"


@pytest.fixture(scope="module")
def server():
    with page_server(port=0) as running:
        yield running


@pytest.fixture
def get(server):
    """Fetch `/` with some headers; return the response, whose body is read."""
    connection = http.client.HTTPConnection(HOST, server.get_port(), timeout=TIMEOUT_S)

    def fetch(**headers):
        connection.request("GET", "/", headers=headers)
        response = connection.getresponse()
        return response, response.read().decode()

    yield fetch
    connection.close()


def recording_start(started):
    """Return viser's own start that also notes down what was started."""
    start = viser.infra.WebsockServer.start

    def noted(server):
        started.append(server)
        start(server)

    return noted


def websocket(server, **options):
    """Open a WebSocket as the page's script does."""
    return connect(
        f"ws://{HOST}:{server.get_port()}",
        subprotocols=[f"viser-v{viser.__version__}"],
        open_timeout=TIMEOUT_S,
        **options,
    )


def test_the_page_is_served_with_headers_that_keep_it_to_itself(server, get):
    response, text = get()
    assert response.status == 200
    assert "<html" in text
    policy = response.headers["Content-Security-Policy"]
    assert "default-src 'self'" in policy
    assert "frame-ancestors 'none'" in policy
    assert response.headers["X-Frame-Options"] == "DENY"


def test_the_pages_own_websocket_is_accepted_and_receives_the_scene(server):
    with websocket(server, origin=server.url) as accepted:
        assert isinstance(accepted.recv(TIMEOUT_S), bytes)


def test_a_foreign_origin_is_refused_before_the_websocket_is_accepted(server):
    with pytest.raises(InvalidStatus) as refused, websocket(server, origin=FOREIGN):
        pass
    response = refused.value.response
    assert response.status_code == 403
    assert FOREIGN.encode() in response.body


@pytest.fixture
def said():
    """Collect the server's log about requests."""
    records: queue.SimpleQueue[logging.LogRecord] = queue.SimpleQueue()
    handler = logging.Handler()
    handler.emit = records.put
    logger = logging.getLogger("arm_viewer.page_server.requests")
    logger.addHandler(handler)
    yield records
    logger.removeHandler(handler)


@pytest.mark.parametrize(
    ("request_line", "reason"),
    [(b"HEAD / HTTP/1.1", "expected GET; got HEAD"), (b"hello", "invalid HTTP request line")],
)
def test_an_invalid_request_is_logged_as_a_sentence(server, said, request_line, reason):
    with socket.create_connection((HOST, server.get_port()), timeout=TIMEOUT_S) as connection:
        connection.sendall(request_line + b"\r\n\r\n")
        while connection.recv(4096):
            pass
    record = said.get(timeout=TIMEOUT_S)
    assert reason in record.getMessage()
    assert "\n" not in record.getMessage()
    assert record.exc_info is None
    assert (record.levelno, record.levelname) == (logging.WARNING, "WARNING")


def test_a_connection_that_breaks_is_not_called_an_unreadable_message(server, said):
    address = server.url.replace("http", "ws", 1) + PATH
    with connect(address, origin=server.url, open_timeout=TIMEOUT_S) as browser:
        browser.close(1011, "keepalive ping timeout")
    said_of_it = said.get(timeout=TIMEOUT_S).getMessage()
    assert said_of_it.startswith("lost the connection to a browser: received 1011")


@pytest.mark.parametrize("length", [300, 7000])
def test_a_path_that_is_too_long_is_refused(server, said, length):
    connection = http.client.HTTPConnection(HOST, server.get_port(), timeout=TIMEOUT_S)
    connection.request("GET", "/" + "a" * length)
    assert connection.getresponse().status == 414
    connection.close()
    assert said.empty()


@pytest.mark.parametrize(
    "message",
    [
        b"\xc1" * 50,  # no MessagePack
        b"",
        "text",
        b"\x81\xa4type\xa3abc",  # {"type": "abc"}: no such message
        b"\x93\x01\x02\x03",  # a list
        b"\x91" * 1500,  # lists in lists
        b"\xdd\xff\xff\xff\xff",  # a list of 4 billion items, of which none comes
    ],
)
def test_an_invalid_message_closes_only_its_own_connection(server, said, message):
    with websocket(server, origin=server.url) as other:
        with websocket(server, origin=server.url) as sender:
            sender.send(message)
            with pytest.raises(websockets.ConnectionClosed) as closed:
                deque(sender, maxlen=0)
        assert closed.value.rcvd.code == 1007
        record = said.get(timeout=TIMEOUT_S)
        assert "closing a connection with an unreadable message" in record.getMessage()
        assert record.exc_info is None
        assert isinstance(other.recv(TIMEOUT_S), bytes)


def test_a_name_that_another_site_points_here_is_refused(server, get):
    rebound = {"Host": "evil.example:8080", "Origin": "http://evil.example:8080"}
    response, text = get(**rebound)
    assert response.status == 403
    assert "only for this machine, not for 'evil.example:8080'" in text


def test_a_taken_port_is_a_sentence_and_no_other_port_is_taken(server):
    port = server.get_port()
    with pytest.raises(PageError, match=rf"port {port} of 127\.0\.0\.1 is taken"):
        PageServer(port)


def test_a_port_beyond_the_last_is_a_sentence():
    with pytest.raises(PageError, match="no port 70000; ports go from 1 to 65535"):
        PageServer(70000)


def test_other_machines_are_not_listened_to(server):
    # All of 127.0.0.0/8 is this machine, so a server on 0.0.0.0 would answer here.
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.2", server.get_port()), timeout=TIMEOUT_S)


def test_no_tunnel_is_opened_and_none_is_tried(server, monkeypatch):
    monkeypatch.setattr("viser._viser.ViserTunnel", None)
    assert server.request_share_url() is None


def test_nothing_is_printed_and_the_port_is_free_after_the_end(capfd):
    first = PageServer(port=0)
    port = first.get_port()
    with websocket(first, origin=first.url) as accepted:
        accepted.recv(TIMEOUT_S)
        first.stop()
    second = PageServer(port)
    second.stop()
    assert second.get_port() == port
    assert capfd.readouterr() == ("", "")


def test_an_unknown_version_of_viser_is_refused(monkeypatch):
    serve = websockets.asyncio.server.serve
    own_way = SimpleNamespace(asyncio=SimpleNamespace(server=SimpleNamespace(serve=serve)))
    monkeypatch.setattr(viser.infra._infra, "websockets", own_way)
    servers = []
    monkeypatch.setattr(
        PageServer, "stop", lambda s: (servers.append(s), viser.ViserServer.stop(s))
    )
    with pytest.raises(PageError, match="foreign pages could drive the robot"):
        PageServer(port=0)
    (stopped,) = servers
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection((HOST, stopped.get_port()), timeout=TIMEOUT_S)
