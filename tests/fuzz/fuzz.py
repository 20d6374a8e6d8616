"""Gives readers inputs that nobody would write, in a process that may die of them.

    python tests/fuzz/fuzz.py urdf --inputs 10000

Input N of a target is always the same; `--first N --inputs 1` repeats it, `--show` prints it. The
result is a line of JSON.
"""

import argparse
import json
import logging
import random
import resource
import signal
import subprocess
import sys
import time
import traceback
from pathlib import Path

import seeds
import targets

MOST_MEMORY_BYTES = 1_000_000_000
LONGEST_S = 5.0
"""Of the processor's time, for one input."""
MOST_FAILURES = 20


def main() -> None:
    """Run one target."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("target", choices=list(targets.TARGETS))
    parser.add_argument("--inputs", type=int, default=300)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--show", action="store_true")
    parser.add_argument("--worker", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    numbers = range(options.first, options.first + options.inputs)
    if options.show:
        for number in numbers:
            sys.stdout.buffer.write(_made(targets.TARGETS[options.target](), number)[1])
    elif options.worker:
        work(options.target, numbers)
    else:
        print(json.dumps(campaign(options.target, numbers)))


def campaign(name: str, numbers: range) -> dict[str, object]:
    """Run workers until every input was read; what kills one is a failure."""
    totals = {"inputs": 0, "refused": 0, "slowest_s": 0.0, "most_mb": 0.0}
    failures: list[str] = []
    first = numbers.start
    while first < numbers.stop and len(failures) < MOST_FAILURES:
        command = [sys.executable, __file__, name, "--worker", "--first", str(first)]
        command += ["--inputs", str(numbers.stop - first)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as worker:
            assert worker.stdout is not None
            for line in worker.stdout:
                row = json.loads(line)
                first = row["number"] + 1
                totals["inputs"] += 1
                totals["refused"] += not row["taken"]
                totals["slowest_s"] = max(totals["slowest_s"], row["s"])
                totals["most_mb"] = max(totals["most_mb"], row["mb"])
                if row["failure"]:
                    failures.append(f"{row['number']}: {row['failure']}")
        if first < numbers.stop:
            failures.append(f"{first}: the process ended with {worker.returncode}")
            totals["inputs"] += 1
            first += 1
    return {"target": name, **totals, "failures": failures}


def work(name: str, numbers: range) -> None:
    """Read the inputs in this process; print a line of JSON for each."""
    logging.disable(logging.CRITICAL)
    resource.setrlimit(resource.RLIMIT_DATA, (2 * MOST_MEMORY_BYTES, 2 * MOST_MEMORY_BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    # Nobody catches it: what takes longer ends the process.
    signal.signal(signal.SIGPROF, signal.SIG_DFL)
    target = targets.TARGETS[name]()
    with seeds.scratch() as folder:
        targets.read_input(target, Path(folder), *_made(target, -1))
        for number in numbers:
            made = _made(target, number)
            before_mb = _forget_peak()
            start_s = time.process_time()
            signal.setitimer(signal.ITIMER_PROF, LONGEST_S)
            taken, failure = True, ""
            try:
                taken = targets.read_input(target, Path(folder), *made)
            except BaseException as error:
                last = traceback.extract_tb(error.__traceback__)[-1]
                where = f"{Path(last.filename).name}:{last.lineno}"
                failure = f"{type(error).__name__} at {where}: {str(error)[:200]}"
            signal.setitimer(signal.ITIMER_PROF, 0)
            row = {"number": number, "taken": taken, "failure": failure}
            row |= {"s": time.process_time() - start_s, "mb": max(0.0, _peak_mb() - before_mb)}
            print(json.dumps(row), flush=True)


def _made(target: targets.Target, number: int) -> tuple[str, bytes]:
    return target.make(random.Random(number))


def _forget_peak() -> float:
    """Reset Linux's count of the peak memory; return the memory that is used now."""
    Path("/proc/self/clear_refs").write_text("5")
    return _peak_mb()


def _peak_mb() -> float:
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith("VmHWM:"):
            return int(line.split()[1]) / 1e3
    return 0.0


if __name__ == "__main__":
    main()
