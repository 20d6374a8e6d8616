"""How long short `arm` commands take from their start to their end, beside a running simulation."""

import argparse
import resource
import statistics
import subprocess
import sys
import time

import harness

LINES = (
    ("--help", 0.25),
    ("topic list", 1.5),
    ("topic echo --once /joint_states", 1.5),
)
"""The words after `arm`, and the target in s."""


def duration_s(words: list[str]) -> float:
    """Return how long the command takes, in seconds."""
    started_s = time.monotonic()
    subprocess.run([sys.executable, "-m", "arm_cli", *words], stdout=subprocess.DEVNULL, check=True)
    return time.monotonic() - started_s


def used_s() -> float:
    """Return the processor time of the commands that ended so far, in seconds."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def row(line: str, target_s: float, runs: int) -> harness.Row:
    """Measure one line."""
    before_s = used_s()
    durations = [duration_s(line.split()) for _ in range(runs)]
    processor_s = (used_s() - before_s) / runs
    spread = f"median {statistics.median(durations):.2f} s, max {max(durations):.2f} s (n={runs})"
    measured = f"{spread}; {processor_s:.2f} s of a core"
    return harness.Row(f"`arm {line}`", measured, f"{target_s:g} s")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=20)
    runs = parser.parse_args().runs
    with harness.suite():
        rows = [row(line, target_s, runs) for line, target_s in LINES]
    harness.print_table("The arm command", rows)


if __name__ == "__main__":
    main()
