"""The gate in front of viser: which requests are answered, and which messages come through."""

import http
import os
from collections.abc import Callable
from typing import Any

from viser._messages import Message, ViewerCameraMessage
from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request, Response

from arm_viewer.access import Access, Role, has_token, is_loopback, without_token
from arm_viewer.channel import PATH
from arm_viewer.served_page import served_page

MAX_PATH = 255
"""Longest path of a request; no file of the page has a longer name."""
PAGES = ("/", "/index.html")

OWNER_HEADER = "Arm-Suite-Page"
"""A header of responses to this machine, for `arm doctor`: the page's user id and ROS domain, and
its address if it needs a token."""

Answer = Callable[[ServerConnection, Request], Response | None]


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
            if not self.is_read_only or is_channel(self) or _is_harmless(message):
                return message


def is_channel(connection: ServerConnection) -> bool:
    """Return whether a WebSocket is of the page's own channel, and not of viser."""
    request = connection.request
    return request is not None and request.path.partition("?")[0] == PATH


def may_change(connection: ServerConnection) -> bool:
    """Return whether a browser may do more than look."""
    return isinstance(connection, PageConnection) and not connection.is_read_only


def _is_harmless(message: str | bytes) -> bool:
    """Return whether viser would read a message as a camera's pose, which is of one browser."""
    # Read as viser reads it: another reader might see another message in the same bytes.
    return isinstance(message, bytes) and isinstance(
        Message.deserialize(message), ViewerCameraMessage
    )


def answer(
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
