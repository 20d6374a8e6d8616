"""Something tried out in a child process, which may fail or crash without harm to this one."""

import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

TIMEOUT_S = 60.0


@dataclass(frozen=True, slots=True)
class Trial:
    """How a child process ended.

    Attributes:
        worked: whether it ended with exit code 0.
        out: what it wrote on stdout.
        complaint: the last line on stderr, or how the process ended.
    """

    worked: bool
    out: str
    complaint: str


def try_command(command: Sequence[str], environ: Mapping[str, str]) -> Trial:
    """Run a command to its end."""
    try:
        done = subprocess.run(
            command,
            env=dict(environ),
            capture_output=True,
            text=True,
            errors="replace",
            stdin=subprocess.DEVNULL,
            timeout=TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return Trial(False, "", f"{command[0]} did not end within {TIMEOUT_S:g} s")
    except OSError as error:
        return Trial(False, "", f"{command[0]}: {error.strerror}")
    lines = [line for line in done.stderr.splitlines() if line.strip()]
    ended = f"{command[0]} ended with code {done.returncode}"
    return Trial(done.returncode == 0, done.stdout, lines[-1].strip() if lines else ended)


def try_python(words: Sequence[str], environ: Mapping[str, str]) -> Trial:
    """Run this same Python with some words on its command line."""
    return try_command([sys.executable, *words], environ)
