"""A display that nobody sees, for the window: Xvfb, whose screen is a file.

Where Xvfb is not installed the tests of this folder are not collected, and the report's head says
so; `.ci/run` installs it.
"""

import ctypes
import os
import select
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

START_TIMEOUT_S = 60.0
SCREEN = "640x480x24"
HEADER_SIZE, WIDTH, HEIGHT, LINE_BYTES, COLOURS = 0, 4, 5, 12, 19
"""Places in the header of a picture by xwd(1), in words of four bytes, big-endian."""
COLOUR_BYTES = 12
CLIENT_MESSAGE = 33

XVFB = shutil.which("Xvfb")
collect_ignore = [] if XVFB else ["test_window.py"]


def pytest_report_header() -> str:
    return f"window tests: {XVFB or 'left out, as there is no Xvfb (apt install xvfb)'}"


class ClientMessage(ctypes.Structure):
    """XClientMessageEvent of Xlib, in the space of an XEvent."""

    _fields_ = (
        ("type", ctypes.c_int),
        ("serial", ctypes.c_ulong),
        ("send_event", ctypes.c_int),
        ("display", ctypes.c_void_p),
        ("window", ctypes.c_ulong),
        ("message_type", ctypes.c_ulong),
        ("format", ctypes.c_int),
        ("data", ctypes.c_long * 5),
        ("rest", ctypes.c_long * 24),
    )


class VirtualDisplay:
    """A running Xvfb: its name, what its screen shows, and a hand that closes windows."""

    def __init__(self, folder: Path) -> None:
        self._screen = folder / "Xvfb_screen0"
        reading, writing = os.pipe()
        self.process = subprocess.Popen(
            [
                *(str(XVFB), "-displayfd", str(writing), "-screen", "0", SCREEN),
                *("-fbdir", str(folder), "-nolisten", "tcp"),
            ],
            pass_fds=(writing,),
            stderr=subprocess.DEVNULL,
        )
        os.close(writing)
        with open(reading) as answer:
            ready, _, _ = select.select([answer], [], [], START_TIMEOUT_S)
            self.name = f":{answer.readline().strip()}" if ready else ":"
        if self.name == ":":
            self.close()
            pytest.fail("Xvfb does not start")

    def picture(self) -> np.ndarray:
        """What the screen shows, (height, width, 4) in the server's order of colours."""
        data = self._screen.read_bytes()
        words = np.frombuffer(data, ">u4", count=COLOURS + 1)
        start = int(words[HEADER_SIZE] + words[COLOURS] * COLOUR_BYTES)
        height, line = int(words[HEIGHT]), int(words[LINE_BYTES])
        lines = np.frombuffer(data, np.uint8, offset=start, count=height * line)
        return lines.reshape(height, line // 4, 4)[:, : int(words[WIDTH])]

    def close_windows(self) -> int:
        """Ask all windows to close, as the cross in their corner does; return how many."""
        x11 = ctypes.CDLL("libX11.so.6")
        x11.XOpenDisplay.restype = ctypes.c_void_p
        x11.XDefaultRootWindow.restype = x11.XInternAtom.restype = ctypes.c_ulong
        display = ctypes.c_void_p(x11.XOpenDisplay(self.name.encode()))
        root, parent, count = ctypes.c_ulong(), ctypes.c_ulong(), ctypes.c_uint()
        windows = ctypes.POINTER(ctypes.c_ulong)()
        top = ctypes.c_ulong(x11.XDefaultRootWindow(display))
        references = [ctypes.byref(value) for value in (root, parent, windows, count)]
        x11.XQueryTree(display, top, *references)
        protocols = x11.XInternAtom(display, b"WM_PROTOCOLS", 0)
        delete = x11.XInternAtom(display, b"WM_DELETE_WINDOW", 0)
        for window in windows[: count.value]:
            message = ClientMessage(
                type=CLIENT_MESSAGE, window=window, message_type=protocols, format=32
            )
            message.data[0] = delete
            x11.XSendEvent(display, ctypes.c_ulong(window), 0, 0, ctypes.byref(message))
        x11.XCloseDisplay(display)
        return count.value

    def close(self) -> None:
        """End the server."""
        self.process.terminate()
        self.process.wait(60.0)


@pytest.fixture
def display(tmp_path: Path) -> Iterator[VirtualDisplay]:
    """Return a display of 640x480, all black."""
    running = VirtualDisplay(tmp_path)
    yield running
    running.close()
