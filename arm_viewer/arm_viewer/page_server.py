"""viser's server behind the page's gate: address, requests and messages, start and end."""

import errno
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
from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import ConnectionClosed, InvalidHandshake
from websockets.frames import CloseCode

from arm_viewer.access import PARAMETER, Access, shown_host
from arm_viewer.channel import Channel
from arm_viewer.errors import PageError
from arm_viewer.page_gate import Answer, PageConnection, answer, is_channel, may_change

MAX_REASON = 200

Handler = Callable[[ServerConnection], Awaitable[None]]


class PageServer(viser.ViserServer):
    """Serves the page on 127.0.0.1, or elsewhere to those who have its token.

    Pages of other origins are refused. A browser that may only look receives everything, and what
    it sends reaches nobody; see `page_gate`.

    Everything else is inherited from viser, including its thread rules.
    """

    def __init__(self, port: int, label: str | None = None, access: Access | None = None) -> None:
        """Serve.

        Args:
            port: TCP port; 0 takes any free one, which `get_port` returns.
            label: title of the page's panel.
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
            super().__init__(self.access.host, port, label=label, verbose=False)
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
def page_server(
    port: int, label: str | None = None, access: Access | None = None
) -> Iterator[PageServer]:
    """Serve while the context lasts; see `PageServer`."""
    server = PageServer(port, label, access)
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
        gate = partial(answer, process_request, access)
        # websockets logs every request, which does not interest the user.
        logger = logging.getLogger(f"{__name__}.requests")
        logger.setLevel(logging.WARNING)
        logger.addFilter(_as_sentence)

        async def handle(connection: ServerConnection) -> None:
            try:
                if is_channel(connection):
                    await channel.serve(connection, may_change=may_change(connection))
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
