"""This Python in a process of its own, run to its end."""

import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

TIMEOUT_S = 120.0


def run_python(
    *arguments: str | Path,
    env: Mapping[str, str] | None = None,
    cwd: Path | None = None,
    check: bool = False,
    timeout_s: float = TIMEOUT_S,
) -> subprocess.CompletedProcess[str]:
    """Run Python with these arguments; return how it ended and what it printed.

    Args:
        arguments: as on a command line, after the program.
        env: its environment; by default that of the tests.
        cwd: its folder; by default that of the tests.
        check: whether a failure is an error.
        timeout_s: how long it may take.
    """
    return subprocess.run(
        [sys.executable, *arguments],
        env=dict(os.environ if env is None else env),
        cwd=cwd,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=timeout_s,
        check=check,
    )
