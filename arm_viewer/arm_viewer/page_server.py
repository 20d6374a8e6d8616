"""viser's server, restricted to this machine: address, request gate, start and end."""

import errno
import http
import logging
import os
import re
import socket
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from functools import cache, partial
from importlib.resources import files
from typing import Any
from urllib.parse import quote, urlsplit

import rich
import viser
import websockets.asyncio.server
from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import ConnectionClosed, InvalidHandshake
from websockets.frames import CloseCode
from websockets.http11 import Request, Response

from arm_viewer.channel import PATH, Channel
from arm_viewer.errors import PageError

HOST = "127.0.0.1"

MAX_PATH = 255
"""Longest path of a request; no file of the page has a longer name."""
MAX_REASON = 200

PAGES = ("/", "/index.html")

OWNER_HEADER = "Arm-Suite-Page"
"""A header of responses: the user id and the ROS domain of the page, for `arm doctor`."""

Handler = Callable[[ServerConnection], Awaitable[None]]
Answer = Callable[[ServerConnection, Request], Response | None]


class PageServer(viser.ViserServer):
    """Serves the page on 127.0.0.1, to the page itself and to programs other than browsers.

    Everything else is inherited from viser, including its thread rules.
    """

    def __init__(self, port: int, label: str | None = None) -> None:
        """Serve.

        Args:
            port: TCP port; 0 takes any free one, which `get_port` returns.
            label: title of the page's panel.

        Raises:
            PageError: the port is taken or not permitted, or requests to the installed version of
                viser cannot be checked.
        """
        self.channel = Channel()
        """Exchanges messages with the scripts of the page; use it in viser's event loop."""
        # viser prints boxes about itself on rich's console, and has no option to switch them off.
        rich.reconfigure(quiet=True)
        listener = _listen(port)
        with _viser_serves_on(listener, self.channel) as guarded:
            super().__init__(HOST, port, label=label, verbose=False)
        if not guarded:
            self.stop()
            listener.close()
            raise PageError(
                f"viser {viser.__version__} does not start its server as expected, so foreign "
                "pages could drive the robot; install a version that pyproject.toml names"
            )

    @property
    def url(self) -> str:
        """The address for the browser."""
        return f"http://{HOST}:{self.get_port()}"

    def request_share_url(self, verbose: bool = True) -> str | None:
        """Refuse to open a tunnel to the outside, which any client could request by a message."""
        return None


@contextmanager
def page_server(port: int, label: str | None = None) -> Iterator[PageServer]:
    """Serve while the context lasts; see `PageServer`."""
    server = PageServer(port, label)
    try:
        yield server
    finally:
        server.stop()


def _listen(port: int) -> socket.socket:
    """Return a socket that listens on the port.

    viser itself would silently take the next port if this one is taken.
    """
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        # Connections of a page that ran here before may still be in TIME_WAIT.
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind((HOST, port))
        # Two pages that start at the same time may both bind, but only one can listen.
        listener.listen()
    except OverflowError:
        listener.close()
        raise PageError(f"there is no port {port}; ports go from 1 to 65535") from None
    except OSError as error:
        listener.close()
        raise PageError(_refusal_to_bind(port, error)) from error
    return listener


def _refusal_to_bind(port: int, error: OSError) -> str:
    if error.errno == errno.EADDRINUSE:
        return (
            f"port {port} of {HOST} is taken, perhaps by another page; end that one, or give this "
            "one another port"
        )
    return f"port {port} of {HOST} cannot be used: {error.strerror}"


@contextmanager
def _viser_serves_on(listener: socket.socket, channel: Channel) -> Iterator[list[socket.socket]]:
    """Make the server that viser starts in this context use the socket and the request gate.

    Connections to PATH are the channel's; viser handles all others.

    viser calls `websockets.asyncio.server.serve` in a thread that its constructor waits for, and
    has no parameter for `process_request` or `sock`, so `serve` is replaced for the duration of the
    context. The returned list contains the socket once viser has called it. An empty list means
    that this version of viser serves in another way and is not guarded.
    """
    guarded: list[socket.socket] = []

    def serve_guarded(
        handler: Handler, _host: str, _port: int, *, process_request: Answer, **options: Any
    ) -> serve:
        guarded.append(listener)
        gate = partial(_answer, process_request)
        # websockets logs every request, which does not interest the user.
        logger = logging.getLogger(f"{__name__}.requests")
        logger.setLevel(logging.WARNING)
        logger.addFilter(_as_sentence)

        async def handle(connection: ServerConnection) -> None:
            try:
                if connection.request is not None and connection.request.path == PATH:
                    await channel.serve(connection)
                else:
                    await handler(connection)
            except ConnectionClosed as error:
                # For example a browser that answers no ping: it connects again by itself.
                logger.warning("lost the connection to a browser: %s", error)
            except Exception as error:
                # The connection's top-level handler: viser raises any kind of error if a client
                # sends anything but a message of the page.
                reason = f"{type(error).__name__}: {error}"[:MAX_REASON]
                logger.warning("closing a connection with an unreadable message: %s", reason)
                await connection.close(CloseCode.INVALID_DATA, "not a message of the page")

        return serve(handle, sock=listener, process_request=gate, logger=logger, **options)

    websockets.asyncio.server.serve = serve_guarded
    try:
        yield guarded
    finally:
        websockets.asyncio.server.serve = serve


def _as_sentence(record: logging.LogRecord) -> bool:
    """Make an invalid request, which is the client's fault, a sentence and no error of the page."""
    error = record.exc_info[1] if record.exc_info else None
    if isinstance(error, InvalidHandshake):
        record.levelno, record.levelname = logging.WARNING, "WARNING"
        record.msg = f"{record.getMessage()}: {error.__cause__ or error}"
        record.args = ()
        record.exc_info = None
    return True


def _answer(inner: Answer, connection: ServerConnection, request: Request) -> Response | None:
    """Refuse a request, or return viser's own response (None to open the WebSocket)."""
    headers = request.headers
    reason = reason_to_refuse(headers.get_all("Host"), headers.get_all("Origin"))
    if reason is not None:
        return connection.respond(http.HTTPStatus.FORBIDDEN, f"{reason}\n")
    if len(request.path.partition("?")[0]) > MAX_PATH:
        return connection.respond(http.HTTPStatus.REQUEST_URI_TOO_LONG, "the path is too long\n")
    is_page = request.path.partition("?")[0] in PAGES
    if is_page and "Accept-Encoding" in request.headers:
        # The page is modified below, and compression gains nothing on the same machine.
        del request.headers["Accept-Encoding"]
    response = inner(connection, request)
    if response is not None:
        if is_page:
            response.body = served_page(bytes(response.body).decode()).encode()
            del response.headers["Content-Length"]
            response.headers["Content-Length"] = str(len(response.body))
        response.headers.update(SECURITY_HEADERS)
        response.headers[OWNER_HEADER] = f"{os.getuid()} {os.environ.get('ROS_DOMAIN_ID') or 0}"
    return response


LOOPBACK_NAMES = ("localhost", "127.0.0.1", "::1")

SECURITY_HEADERS = {
    # All content comes from the page itself, and no site may embed it in a frame (clickjacking).
    "Content-Security-Policy": (
        "default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:; "
        "connect-src 'self' data: blob:; frame-ancestors 'none'"
    ),
    "X-Frame-Options": "DENY",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
}
"""Headers of every response."""


def reason_to_refuse(hosts: list[str], origins: list[str]) -> str | None:
    """Return why a request is refused, in a sentence, or None to accept it.

    The page drives an arm, and every web site that the user visits could open connections to this
    machine. Two headers that a site's scripts cannot change identify such a site. A browser sends
    the Origin with every WebSocket request, and it must be the page's own. A site may also point
    its own name to this machine ("DNS rebinding") and so become the same origin. Its name is then
    in the Host header, so Host must be a name of this machine. Other programs are accepted.

    The port is not compared with the server's, because a tunnel (`ssh -L`) may have another one at
    the user's end.

    Args:
        hosts: values of the request's Host headers.
        origins: values of the request's Origin headers.
    """
    if len(hosts) != 1 or not _is_loopback(hosts[0]):
        return (
            f"this page is only for this machine, not for {_listed(hosts)}; "
            "open it as http://127.0.0.1 or http://localhost with its port"
        )
    if any(origin != f"http://{hosts[0]}" for origin in origins):
        return f"a page of {_listed(origins)} may not use this one, which is http://{hosts[0]}"
    return None


def _is_loopback(host: str) -> bool:
    try:
        return urlsplit(f"//{host}").hostname in LOOPBACK_NAMES
    except ValueError:
        return False


def _listed(values: list[str]) -> str:
    return ", ".join(map(repr, values)) or "an unnamed host"


TITLE = "Arm suite"
SCRIPTS = (
    "software_rendering.js",
    "channel.js",
    "poses.js",
    "typed_numbers.js",
    "quiet.js",
    "time_bar.js",
    "keys.js",
)
STYLES = ("page.css", "time_bar.css")
PARTS = ("time_bar.html",)
_ICON = re.compile(r'<link\s+rel="icon"\s[^>]*>', re.DOTALL)
_TITLE = re.compile(r"<title>[^<]*</title>")
_HEAD_END, _BODY = "</head>", "<body>"


@cache
def served_page(html: str) -> str:
    """Return viser's page with the project's additions.

    Args:
        html: viser's index.html.
    """
    icon = f'<link rel="icon" href="data:image/svg+xml,{quote(_read_asset("icon.svg"))}" />'
    scripts = "".join(f"<script>{_read_asset(name)}</script>" for name in SCRIPTS)
    styles = "".join(f"<style>{_read_asset(name)}</style>" for name in STYLES)
    parts = "".join(_read_asset(name) for name in PARTS)
    # A function, because `sub` would interpret backslashes in a replacement string.
    html = _ICON.sub(lambda _: icon, html, count=1)
    html = _TITLE.sub(lambda _: f"<title>{TITLE}</title>", html, count=1)
    head, end, rest = html.partition(_HEAD_END)
    before, body, after = rest.partition(_BODY)
    return f"{head}{styles}{scripts}{end}{before}{body}{parts}{after}"


def _read_asset(name: str) -> str:
    return files("arm_viewer.front").joinpath(name).read_text(encoding="utf-8")
