"""Gives a process that was started without a standard stream one that leads nowhere."""

import os
import sys


def open_closed_streams() -> None:
    """Open what a shell's `<&-` or `>&-` has closed.

    Otherwise the next file that is opened would take its number, and get what is printed.
    """
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            # In this order each gets the number that it would have had.
            setattr(sys, name, open(os.devnull, mode, encoding="utf-8"))  # noqa: SIM115
