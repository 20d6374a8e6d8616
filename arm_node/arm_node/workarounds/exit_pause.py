"""Ends a command without the pause that Fast DDS makes when its process exits.

Fast DDS sleeps for 0.1 s while the process unloads it, although no participant is left. That is a
tenth of the time of a command. This works around Fast DDS 2.14 and 3.2, whose `RTPSDomain::stopAll`
sleeps; no upstream issue is known.
"""

import os
import sys
import threading
from contextlib import suppress
from typing import NoReturn

from arm_node.workarounds.switch import is_on


def end_process(exit_code: int) -> NoReturn:
    """End this process; call it last in the main thread, when all nodes are destroyed.

    Functions registered with `atexit` do not run if ROS was used. A process with other threads, or
    whose output cannot be written, ends as usual.
    """
    if "rclpy" in sys.modules and threading.active_count() == 1 and is_on("exit_pause"):
        with suppress(OSError, ValueError):
            for stream in filter(None, (sys.stdout, sys.stderr)):
                stream.flush()
            os._exit(exit_code)
    sys.exit(exit_code)
