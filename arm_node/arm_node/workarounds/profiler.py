"""Switches off MuJoCo's timers, which nothing in the suite reads.

MuJoCo's Python package gives the library a clock, and every step reads it about twenty times: a
fifth of the time of a small arm's step. `mujoco.set_mjcb_time(None)` restores that clock instead of
removing it, so this clears the C variable `mjcb_time` itself. Made for MuJoCo 4.0; no upstream
issue is known.
"""

import ctypes
import logging
from pathlib import Path
from types import ModuleType

from arm_node.workarounds.switch import LIBRARIES, is_on

logger = logging.getLogger(__name__)


def switch_off_profiler(mujoco: ModuleType) -> None:
    """Stop MuJoCo, which only `arm_gazebo` imports, from timing its steps in this process."""
    if not is_on("profiler"):
        library = LIBRARIES["profiler"]
        if not library.fits:
            logger.info("workaround profiler is off: made for %s", library)
        return
    # The library's name contains the version and depends on the platform.
    for library in Path(mujoco.__file__ or "").parent.glob("*mujoco*"):
        if {".so", ".dylib", ".dll"} & set(library.suffixes):
            try:
                ctypes.c_void_p.in_dll(ctypes.CDLL(str(library)), "mjcb_time").value = None
            except (OSError, ValueError) as error:
                logger.info("workaround profiler is off: %s", error)
