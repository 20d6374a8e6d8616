"""Rate, period, latency, processor and memory of the simulation at 100 and 500 Hz."""

import argparse
import subprocess
import sys
import time

import harness
import numpy as np

BARE_LOOP = """
import sys, time
period, seconds = float(sys.argv[1]), float(sys.argv[2])
wakes, due = [], time.monotonic()
end = due + seconds
while due < end:
    due += period
    time.sleep(max(0.0, due - time.monotonic()))
    wakes.append(time.monotonic())
print(",".join(map(repr, wakes)))
"""


def bare_loop(rate_hz: int, seconds: float) -> subprocess.Popen:
    """Start a loop that only sleeps to absolute deadlines, in a process of its own."""
    return subprocess.Popen(
        [sys.executable, "-c", BARE_LOOP, str(1 / rate_hz), str(seconds)],
        stdout=subprocess.PIPE,
        text=True,
    )


def periods(rate_hz: int, seconds: float) -> list[harness.Row]:
    """Measure the rate and the period with the camera on, beside a bare sleeping loop."""
    with harness.suite("world:=objects", rate_hz=rate_hz):
        camera = harness.Client("record", "--topic", "/videocamera", "--seconds", str(seconds + 2))
        states = harness.Client("record", "--seconds", str(seconds))
        bare = bare_loop(rate_hz, seconds)
        arrivals = np.array(states.answer()["arrivals_s"])
        wakes = np.array([float(x) for x in bare.communicate()[0].split(",")])
        camera.answer()
        states.stop()
        camera.stop()
    rate = (len(arrivals) - 1) / (arrivals[-1] - arrivals[0])
    ours = np.diff(arrivals) * 1e3
    bare_ms = np.diff(wakes) * 1e3
    p99, bare_p99 = np.percentile(ours, 99), np.percentile(bare_ms, 99)
    return [
        harness.Row(
            f"{rate_hz} Hz, camera on: /joint_states rate",
            f"{100 * rate / rate_hz:.2f} %",
            "99.5 %",
        ),
        harness.Row(
            f"{rate_hz} Hz: period p50 / p99 / max; bare sleeping loop p99; ratio",
            f"{np.median(ours):.2f} / {p99:.2f} / {ours.max():.2f} ms; "
            f"{bare_p99:.2f} ms; {p99 / bare_p99:.2f}",
            "1.2 x" if rate_hz == 100 else "",
        ),
    ]


def latency(rate_hz: int, steps: int) -> harness.Row:
    """Measure from a published command to the first joint state that shows motion."""
    with harness.suite("camera:=none", rate_hz=rate_hz):
        client = harness.Client("latency", "--steps", str(steps))
        p50, p99 = harness.percentiles(client.answer()["latencies_s"], 50, 99)
        client.stop()
    return harness.Row(
        f"{rate_hz} Hz: command to first motion p50 / p99",
        f"{p50 * 1e3:.1f} / {p99 * 1e3:.1f} ms (n={steps})",
        "9 ms" if rate_hz == 100 else "3.5 ms",
    )


def idle_cost(rate_hz: int, seconds: float) -> list[harness.Row]:
    """Measure processor and memory of the simulation process, nobody watching the camera."""
    with harness.suite(rate_hz=rate_hz) as running:
        process = running.find("arm_gazebo_node")
        time.sleep(2.0)
        percent = harness.cpu_percent(process, seconds)
        memory = process.memory_info().rss / 1e6
    return [
        harness.Row(
            f"{rate_hz} Hz: CPU of the simulation process, no camera subscriber",
            f"{percent:.1f} % of a core",
            "8 %" if rate_hz == 100 else "18 %",
        ),
        harness.Row(
            f"{rate_hz} Hz: memory of the simulation process", f"{memory:.0f} MB", "180 MB"
        ),
    ]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--steps", type=int, default=60)
    arguments = parser.parse_args()
    rows = []
    for rate_hz in (100, 500):
        rows += periods(rate_hz, arguments.seconds)
        rows.append(latency(rate_hz, arguments.steps))
        rows += idle_cost(rate_hz, arguments.seconds)
    harness.print_table("Control loop", rows)


if __name__ == "__main__":
    main()
