"""viser's server, for this machine only: its address, its gate, its orderly start and end."""

import errno
import http
import logging
import socket
from collections.abc import Awaitable, Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

import rich
import viser
import websockets.asyncio.server
from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import InvalidHandshake
from websockets.http11 import Request, Response

from arm_viewer.errors import PageError
from arm_viewer.request_gate import SECURITY_HEADERS, reason_to_refuse

HOST = "127.0.0.1"

Handler = Callable[[ServerConnection], Awaitable[None]]
Answer = Callable[[ServerConnection, Request], Response | None]


class PageServer(viser.ViserServer):
    """Serves the page on 127.0.0.1, to the page itself and to programs that are no browser.

    Everything else is viser's, thread rules included.
    """

    def __init__(self, port: int, label: str | None = None) -> None:
        """Serve.

        Args:
            port: of TCP; 0 takes any free one, which `get_port` then tells.
            label: title of the page's panel.

        Raises:
            PageError: the port is taken or may not be used, or the installed viser cannot be
                guarded.
        """
        # viser prints boxes about itself by rich's own console, and has no switch against it.
        rich.reconfigure(quiet=True)
        listener = _listen(port)
        with _viser_serves_on(listener) as guarded:
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
        """Open no tunnel to the outside, whoever asks for it: a client may, by a message."""
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

    viser would bind by itself, and silently take the next port where this one is taken.
    """
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        # Connections of the page that ran here before may still be dying away.
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind((HOST, port))
        # Two that start at once may both bind, but only one may listen.
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
def _viser_serves_on(listener: socket.socket) -> Iterator[list[socket.socket]]:
    """Put the gate before what viser starts to serve in the context, and let it use the socket.

    viser calls `websockets.asyncio.server.serve` in a thread that its constructor waits for, and
    leaves no parameter for `process_request` or `sock`; so `serve` has them in place for the
    while. The list that is handed out holds the socket once that has happened: an empty one means
    that viser has other ways by now, and serves unguarded.
    """
    guarded: list[socket.socket] = []

    def serve_guarded(
        handler: Handler, _host: str, _port: int, *, process_request: Answer, **options: Any
    ) -> serve:
        guarded.append(listener)
        gate = partial(_answer, process_request)
        # Every request is worth a line to websockets, but not to the user.
        logger = logging.getLogger(f"{__name__}.requests")
        logger.setLevel(logging.WARNING)
        logger.addFilter(_as_sentence)
        return serve(handler, sock=listener, process_request=gate, logger=logger, **options)

    websockets.asyncio.server.serve = serve_guarded
    try:
        yield guarded
    finally:
        websockets.asyncio.server.serve = serve


def _as_sentence(record: logging.LogRecord) -> bool:
    """Say what is wrong with a request, which is not ours to mend, without a traceback."""
    error = record.exc_info[1] if record.exc_info else None
    if isinstance(error, InvalidHandshake):
        record.msg = f"{record.getMessage()}: {error.__cause__ or error}"
        record.args = ()
        record.exc_info = None
    return True


def _answer(inner: Answer, connection: ServerConnection, request: Request) -> Response | None:
    """Refuse a request, or give viser's own answer (None: open the WebSocket)."""
    headers = request.headers
    reason = reason_to_refuse(headers.get_all("Host"), headers.get_all("Origin"))
    if reason is not None:
        return connection.respond(http.HTTPStatus.FORBIDDEN, f"{reason}\n")
    response = inner(connection, request)
    if response is not None:
        response.headers.update(SECURITY_HEADERS)
    return response
