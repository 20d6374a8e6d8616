"""The simulation as its children see it: they do not outlive it."""

import argparse
import ctypes
import os
import signal

from arm_gazebo.errors import OrphanError

PR_SET_PDEATHSIG = 1
NICENESS = 5
"""Software OpenGL takes all processors when it starts: the physics comes first."""


def add_parent_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments that every child of the simulation gets."""
    parser.add_argument("--socket", type=int, required=True, help="descriptor, inherited")
    parser.add_argument("--parent", type=int, required=True, help="process id of the simulation")


def follow_parent(parent: int) -> None:
    """Let the simulation go first on the processor, and end with it, even while a driver hangs.

    Raises:
        OrphanError: the simulation has ended already.
    """
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM, 0, 0, 0)
    if os.getppid() != parent:
        raise OrphanError("the simulation that started this process has ended")
    os.nice(NICENESS)
