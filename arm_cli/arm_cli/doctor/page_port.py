"""Can the page be served?"""

import socket
from dataclasses import dataclass
from http.client import HTTPConnection, HTTPException

from arm_cli.doctor.finding import Finding

NAME = "page"
HOST, PORT = "127.0.0.1", 8080
PATIENCE_S = 2.0
MARK = b"viser"
"""Every page of the arm suite names what it is made with."""


@dataclass(frozen=True, slots=True)
class PagePort:
    """Looks who has the port of the page.

    Attributes:
        port: of TCP, on this machine alone.
    """

    port: int = PORT

    def examine(self) -> Finding:
        """Try to take the port; where somebody has it, ask whether it is a page."""
        if self._is_free():
            return Finding.ok(NAME, f"port {self.port} is free for it")
        if self._serves_a_page():
            return Finding.ok(NAME, f"there is one on http://{HOST}:{self.port}")
        return Finding.warning(
            NAME,
            f"port {self.port} is taken by another program",
            f"ss -tlpn 'sport = :{self.port}' shows which; end it, or give the page another port: "
            "arm view --port 8081, arm launch viewer:=true viewer_port:=8081",
        )

    def _is_free(self) -> bool:
        with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
            # Connections of a page that has ended do not count.
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                probe.bind((HOST, self.port))
            except OSError:
                return False
            return True

    def _serves_a_page(self) -> bool:
        connection = HTTPConnection(HOST, self.port, timeout=PATIENCE_S)
        try:
            connection.request("GET", "/")
            return MARK in connection.getresponse().read().lower()
        except (OSError, HTTPException):
            return False
        finally:
            connection.close()
