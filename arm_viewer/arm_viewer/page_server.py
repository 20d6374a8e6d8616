"""viser's server behind a gate: where it listens, which requests and messages come through."""

import errno
import http
import logging
import os
import socket
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

import rich
import viser
import websockets.asyncio.server
from viser._messages import Message, ViewerCameraMessage
from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import ConnectionClosed, InvalidHandshake
from websockets.frames import CloseCode
from websockets.http11 import Request, Response

from arm_viewer.access import (
    PARAMETER,
    Access,
    Role,
    has_token,
    is_loopback,
    shown_host,
    without_token,
)
from arm_viewer.channel import PATH, Channel
from arm_viewer.errors import PageError
from arm_viewer.front import served_page

MAX_REASON = 200
MAX_PATH = 255
"""Longest path of a request; no file of the page has a longer name."""
PAGES = ("/", "/index.html")

OWNER_HEADER = "Arm-Suite-Page"
"""A header of responses to this machine, for `arm doctor`: the page's user id and ROS domain, and
its address if it needs a token."""
NO_TOKEN = (
    "this page opens with the address that `arm view` printed, which has a token; if the page was "
    "started anew, it has printed a new one"
)
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

Handler = Callable[[ServerConnection], Awaitable[None]]
Answer = Callable[[ServerConnection, Request], Response | None]


class PageServer(viser.ViserServer):
    """Serves the page on 127.0.0.1, or elsewhere to those who have its token.

    Pages of other origins are refused. A browser that may only look receives everything, and what
    it sends reaches nobody; see `PageConnection`.

    Everything else is inherited from viser, including its thread rules.
    """

    def __init__(self, port: int, access: Access | None = None) -> None:
        """Serve.

        Args:
            port: TCP port; 0 takes any free one, which `get_port` returns.
            access: who may open the page; by default this machine alone.

        Raises:
            PageError: the address cannot be listened on, or requests to the installed version of
                viser cannot be checked.
        """
        self.access = access or Access()
        """Who may open the page."""
        self.channel = Channel()
        """Exchanges messages with the scripts of the page; use it in viser's event loop."""
        # viser prints boxes about itself on rich's console, and has no option to switch them off.
        rich.reconfigure(quiet=True)
        listener = _listen(self.access.host, port)
        with _viser_serves_on(listener, self.channel, self.access) as guarded:
            super().__init__(self.access.host, port, verbose=False)
        if not guarded:
            self.stop()
            listener.close()
            raise PageError(
                f"viser {viser.__version__} does not start its server as expected, so foreign "
                "pages could drive the robot; install a version that pyproject.toml names"
            )

    @property
    def url(self) -> str:
        """The address for the browser, without a token."""
        return f"http://{shown_host(self.access.host)}:{self.get_port()}"

    def url_with(self, token: str) -> str:
        """Return the address that a token opens."""
        return f"{self.url}/?{PARAMETER}={token}"

    def request_share_url(self, verbose: bool = True) -> str | None:
        """Refuse to open a tunnel to the outside, which any client could request by a message."""
        return None


@contextmanager
def page_server(port: int, access: Access | None = None) -> Iterator[PageServer]:
    """Serve while the context lasts; see `PageServer`."""
    server = PageServer(port, access)
    try:
        yield server
    finally:
        server.stop()


def _listen(host: str, port: int) -> socket.socket:
    """Return a socket that listens on the port.

    viser itself would silently take the next port if this one is taken.
    """
    listener = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET, socket.SOCK_STREAM)
    try:
        # Connections of a page that ran here before may still be in TIME_WAIT.
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind((host, port))
        # Two pages that start at the same time may both bind, but only one can listen.
        listener.listen()
    except OverflowError:
        listener.close()
        raise PageError(f"there is no port {port}; ports go from 1 to 65535") from None
    except (OSError, UnicodeError) as error:
        listener.close()
        raise PageError(_refusal_to_bind(host, port, error)) from error
    return listener


def _refusal_to_bind(host: str, port: int, error: Exception) -> str:
    code = getattr(error, "errno", None)
    if code == errno.EADDRINUSE:
        return (
            f"port {port} of {host} is taken, perhaps by another page; end that one, or give this "
            "one another port"
        )
    if code == errno.EADDRNOTAVAIL or isinstance(error, socket.gaierror | UnicodeError):
        return (
            f"{host!r} is not an address of this machine; 0.0.0.0 stands for all of them, and "
            "127.0.0.1 for this machine alone"
        )
    return f"port {port} of {host} cannot be used: {os.strerror(code) if code else error}"


@contextmanager
def _viser_serves_on(
    listener: socket.socket, channel: Channel, access: Access
) -> Iterator[list[socket.socket]]:
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
        gate = partial(_answer, process_request, access)
        # websockets logs every request, which does not interest the user.
        logger = logging.getLogger(f"{__name__}.requests")
        logger.setLevel(logging.WARNING)
        logger.addFilter(_as_sentence)

        async def handle(connection: ServerConnection) -> None:
            try:
                if _is_channel(connection):
                    await channel.serve(connection, may_change=_may_change(connection))
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

        return serve(
            handle,
            sock=listener,
            process_request=gate,
            logger=logger,
            create_connection=PageConnection,
            **options,
        )

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


class PageConnection(ServerConnection):
    """A browser's WebSocket; of one that may only look, viser receives the camera's pose alone.

    viser carries out every update that a browser sends. The channel refuses by itself, because its
    answer is a sentence.

    Attributes:
        is_read_only: whether the browser may only look; true until its request was judged.
    """

    is_read_only = True

    async def recv(self, decode: bool | None = None) -> Any:
        """Return the next message that the browser may send.

        Raises:
            ConnectionClosed: there are no more.
        """
        while True:
            message = await super().recv(decode)
            if not self.is_read_only or _is_channel(self) or _is_harmless(message):
                return message


def _is_channel(connection: ServerConnection) -> bool:
    """Return whether a WebSocket is of the page's own channel, and not of viser."""
    request = connection.request
    return request is not None and request.path.partition("?")[0] == PATH


def _may_change(connection: ServerConnection) -> bool:
    """Return whether a browser may do more than look."""
    return isinstance(connection, PageConnection) and not connection.is_read_only


def _is_harmless(message: str | bytes) -> bool:
    """Return whether viser would read a message as a camera's pose, which is of one browser."""
    # Read as viser reads it: another reader might see another message in the same bytes.
    return isinstance(message, bytes) and isinstance(
        Message.deserialize(message), ViewerCameraMessage
    )


def _answer(
    inner: Answer, access: Access, connection: ServerConnection, request: Request
) -> Response | None:
    """Refuse a request, or return viser's own response (None to open the WebSocket)."""
    headers = request.headers
    reason = access.reason_to_refuse(headers.get_all("Host"), headers.get_all("Origin"))
    if reason is not None:
        return connection.respond(http.HTTPStatus.FORBIDDEN, f"{reason}\n")
    path = request.path.partition("?")[0]
    if len(path) > MAX_PATH:
        return connection.respond(http.HTTPStatus.REQUEST_URI_TOO_LONG, "the path is too long\n")
    cookie = f"arm_page_{connection.local_address[1]}"
    role = access.role(request.path, headers, cookie)
    if isinstance(connection, PageConnection):
        connection.is_read_only = role is not Role.USER
    is_page = path in PAGES
    if role is Role.STRANGER:
        response = connection.respond(http.HTTPStatus.UNAUTHORIZED, f"{NO_TOKEN}\n")
    elif is_page and access.needs_token and has_token(request.path):
        response = _with_cookie(connection, access, request.path, cookie, role)
    else:
        if is_page and "Accept-Encoding" in headers:
            # The page is modified below, and compression gains nothing on the same machine.
            del headers["Accept-Encoding"]
        response = inner(connection, request)
        if response is not None and is_page:
            html = served_page(bytes(response.body).decode(), role is Role.VIEWER)
            response.body = html.encode()
            del response.headers["Content-Length"]
            response.headers["Content-Length"] = str(len(response.body))
    if response is not None:
        response.headers.update(SECURITY_HEADERS)
        if is_loopback(connection.remote_address[0]):
            response.headers[OWNER_HEADER] = _owner(access)
    return response


def _with_cookie(
    connection: ServerConnection, access: Access, path: str, cookie: str, role: Role
) -> Response:
    """Return the way to the page without the token, which the browser keeps as a cookie.

    The token is then neither in the history nor in a picture of the window. Cookies do not tell
    ports apart, so the name has it.
    """
    token = access.token if role is Role.USER else access.read_only_token
    response = connection.respond(http.HTTPStatus.SEE_OTHER, "")
    response.headers["Location"] = without_token(path)
    # Lax: with Strict, a link in a message would arrive without the cookie.
    response.headers["Set-Cookie"] = f"{cookie}={token}; Path=/; HttpOnly; SameSite=Lax"
    response.headers["Cache-Control"] = "no-store"
    return response


def _owner(access: Access) -> str:
    words = [str(os.getuid()), os.environ.get("ROS_DOMAIN_ID") or "0"]
    return " ".join(words + [access.host] * access.needs_token)
