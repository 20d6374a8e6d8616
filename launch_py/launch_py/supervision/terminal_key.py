"""Watches the space bar on the terminal that a launch was started from."""

from __future__ import annotations

import os
import select
import termios
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass

KEY = b" "
LOCAL_MODES = 3
"""Index of the local modes in what `termios.tcgetattr` returns."""
BACKGROUND_POLL_S = 0.5
"""How often a launch in the background checks whether it is in the foreground again."""


@dataclass(frozen=True, slots=True)
class KeyCommand:
    """A command for the space bar.

    Attributes:
        what: its name on the screen, such as "emergency stop".
        words: the command and its arguments.
    """

    what: str
    words: tuple[str, ...]


def is_in_foreground(fd: int) -> bool:
    """Return whether keys typed on this terminal are meant for this process."""
    try:
        return os.isatty(fd) and os.tcgetpgrp(fd) == os.getpgrp()
    except OSError:  # It is not a terminal, or not the one of this process.
        return False


@contextmanager
def space_bar_watched(fd: int, press: Callable[[], None]) -> Iterator[None]:
    """Call back for each press of the space bar, on a thread of its own; Ctrl-C works as before.

    In the background nothing is read, because the keys belong to the shell. Without a terminal
    nothing happens.

    Args:
        fd: standard input.
        press: called for each press.
    """
    if not is_in_foreground(fd):
        yield
        return
    before = termios.tcgetattr(fd)
    _take_single_keys(fd)
    ending = threading.Event()
    # A daemon thread, because it may still wait for a key when the process ends.
    threading.Thread(target=_listen, args=(fd, press, ending), daemon=True).start()
    try:
        yield
    finally:
        ending.set()
        if is_in_foreground(fd):
            with suppress(termios.error):
                termios.tcsetattr(fd, termios.TCSANOW, before)


def _take_single_keys(fd: int) -> None:
    """Deliver each key at once and do not show it."""
    modes = termios.tcgetattr(fd)
    modes[LOCAL_MODES] &= ~(termios.ICANON | termios.ECHO)
    termios.tcsetattr(fd, termios.TCSANOW, modes)


def _listen(fd: int, press: Callable[[], None], ending: threading.Event) -> None:
    was_away = False
    while not ending.is_set():
        if not is_in_foreground(fd):
            was_away = True
            time.sleep(BACKGROUND_POLL_S)
            continue
        if was_away:
            # The shell has changed the terminal's modes in the meantime.
            was_away = False
            _take_single_keys(fd)
        if not select.select([fd], [], [], BACKGROUND_POLL_S)[0] or not is_in_foreground(fd):
            continue
        try:
            typed = os.read(fd, 1024)
        except OSError:  # The terminal has gone.
            return
        if not typed:
            return
        if KEY in typed:
            press()
