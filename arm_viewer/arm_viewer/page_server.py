"""The web server of the page, for this machine alone."""

import contextlib
import io
from collections.abc import Iterator
from contextlib import contextmanager

from viser import ViserServer

from arm_viewer.errors import PageError

HOST = "127.0.0.1"


@contextmanager
def page_server(port: int) -> Iterator[ViserServer]:
    """Serve an empty page.

    Raises:
        PageError: the port is taken.
    """
    with contextlib.redirect_stdout(io.StringIO()):
        server = ViserServer(host=HOST, port=port, label="arm", verbose=False)
    try:
        if server.get_port() != port:
            raise PageError(f"port {port} of {HOST} is taken; give another with -p port:=NUMBER")
        yield server
    finally:
        server.stop()
