"""MuJoCo's profiler of its own steps, which nothing here reads."""

import ctypes
from pathlib import Path

import mujoco


def switch_off() -> None:
    """Let MuJoCo's steps take no times any more, in the whole process.

    Its Python package gives it a clock, and every step reads that some twenty times: a fifth of
    the time of a small arm's step. `mujoco.set_mjcb_time(None)` brings that clock back instead
    of taking it away, so the C variable `mjcb_time` itself is cleared.
    """
    # The file's name ends in the version, and differs from system to system.
    for library in Path(mujoco.__file__).parent.glob("*mujoco*"):
        if {".so", ".dylib", ".dll"} & set(library.suffixes):
            ctypes.c_void_p.in_dll(ctypes.CDLL(str(library)), "mjcb_time").value = None
