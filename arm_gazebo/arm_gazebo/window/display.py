"""Check that a window can open on the display that the environment names."""

import os
import re
import socket
from collections.abc import Iterator, Mapping
from contextlib import suppress

from arm_gazebo.errors import WindowError

LOCAL_DISPLAY = re.compile(r"(?:unix)?:(\d+)(?:\.\d+)?")
X11_SOCKET = "/tmp/.X11-unix/X"
CONNECT_TIMEOUT_S = 2.0
ADVICE = (
    "set DISPLAY to a display that runs ('ssh -X', or 'Xvfb :99' and DISPLAY=:99), "
    "or leave out headless:=false"
)


def check_display(environ: Mapping[str, str] = os.environ) -> None:
    """Check that a window can open, as far as possible without opening one.

    Raises:
        WindowError: there is no display, or no server answers on it.
    """
    if environ.get("WAYLAND_DISPLAY"):
        return
    display = environ.get("DISPLAY", "")
    if not display:
        raise WindowError(
            "headless:=false opens a window, and there is no display: DISPLAY is not set; " + ADVICE
        )
    local = LOCAL_DISPLAY.fullmatch(display)
    # Displays on other machines are left to the window process, which reports their faults.
    if local is not None and not any(_answers(path) for path in _sockets(local.group(1))):
        raise WindowError(
            f"headless:=false opens a window, and no X server answers on DISPLAY={display}; "
            + ADVICE
        )


def _sockets(number: str) -> Iterator[str]:
    path = f"{X11_SOCKET}{number}"
    yield path
    yield f"\0{path}"


def _answers(path: str) -> bool:
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as connection, suppress(OSError):
        connection.settimeout(CONNECT_TIMEOUT_S)
        connection.connect(path)
        return True
    return False
