"""Control rate while the simulation's process is kept busy, against the same without.

Two disturbances: many subscribers to the camera, each a process that comes while the arm runs, and
one FollowJointTrajectory goal with very many points. What is compared is simulated time over wall
time, so that a machine that is busy with something else counts in both.
"""

import argparse
import contextlib
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import harness
import numpy as np

CLIENT = Path(__file__).with_name("busy_client.py")
CONTROLLERS = """\
controller_manager:
  ros__parameters:
    update_rate: {rate_hz}
    joint_state_broadcaster:
      type: joint_state_broadcaster/JointStateBroadcaster
    position_controller:
      type: joint_trajectory_controller/JointTrajectoryController
position_controller:
  ros__parameters:
    joints: [j0, j1, j2, j3]
    command_interfaces: [position]
    state_interfaces: [position, velocity]
"""
ACTION = "/position_controller/follow_joint_trajectory"


def pace(ticks: np.ndarray, since_s: float, until_s: float) -> tuple[float, float]:
    """Return simulated over wall time between two wall times, and the longest pause in s."""
    chosen = ticks[(ticks[:, 0] >= since_s) & (ticks[:, 0] <= until_s)]
    wall, simulated = chosen[-1] - chosen[0]
    return float(simulated / wall), float(np.diff(chosen[:, 0]).max())


class Watched:
    """A running arm whose /clock is watched."""

    def __init__(self, seconds: float) -> None:
        self._watcher = harness.Client("watch", "--seconds", str(seconds), script=CLIENT)
        self._watcher.answer()
        self.began_s = time.monotonic()

    def figures(self) -> tuple[np.ndarray, list]:
        """Return wall and simulated time of each tick, and the lags that the manager told."""
        answer = self._watcher.answer()
        self._watcher.stop()
        return np.array(answer["ticks"]), answer["lags"]


@contextlib.contextmanager
def arm(*arguments: str, rate_hz: int) -> Iterator[None]:
    """Run the arm with a trajectory controller."""
    with harness.suite(*arguments, rate_hz=rate_hz, parameters=CONTROLLERS):
        yield


def disturbed(title: str, before: tuple, during: tuple, lags: list, more: str) -> list[harness.Row]:
    """Return the rows of one run."""
    lag_ms = max((lag for _, lag, _ in lags), default=float("nan"))
    return [
        harness.Row(
            f"{title}: simulated over wall time, before / during; ratio",
            f"{before[0]:.3f} / {during[0]:.3f}; {100 * during[0] / before[0]:.1f} %",
            "95 %",
        ),
        harness.Row(
            f"{title}: longest pause between two ticks, before / during; latest tick; {more}",
            f"{1e3 * before[1]:.0f} / {1e3 * during[1]:.0f} ms; {lag_ms:.0f} ms",
        ),
    ]


def subscribers(count: int, seconds: float, rate_hz: int) -> list[harness.Row]:
    """Measure while so many subscribers come, stay, and go."""
    with arm("world:=objects", rate_hz=rate_hz):
        watched = Watched(2 * seconds)
        time.sleep(seconds / 2)
        began_s = time.monotonic()
        clients = [
            harness.Client("pictures", "--seconds", str(seconds), script=CLIENT)
            for _ in range(count)
        ]
        pictures = []
        for client in clients:
            with contextlib.suppress(SystemExit):  # It hung, and ended itself.
                pictures.append(client.answer()["pictures"])
        ended_s = time.monotonic()
        for client in clients:
            client.stop()
        ticks, lags = watched.figures()
    return disturbed(
        f"{count} image subscribers, {rate_hz} Hz",
        pace(ticks, watched.began_s, began_s),
        pace(ticks, began_s, ended_s),
        lags,
        f"pictures {min(pictures)} to {max(pictures)} each, from {len(pictures)} clients",
    )


def large_goal(points: int, seconds: float, rate_hz: int) -> list[harness.Row]:
    """Measure while a goal of so many points is sent, taken, checked and begun."""
    with arm("camera:=none", rate_hz=rate_hz):
        sender = subprocess.Popen(
            [
                *(sys.executable, str(CLIENT), "goal", "--points", str(points)),
                *("--seconds", "60", "--action", ACTION),
            ],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=harness.client_environment(),
        )
        assert sender.stdin is not None
        assert sender.stdout is not None
        sender.stdout.readline()
        watched = Watched(3 * seconds)
        time.sleep(seconds)
        began_s = time.monotonic()
        sender.stdin.write("\n")
        sender.stdin.flush()
        answer = sender.stdout.readline().strip()
        answered_s = time.monotonic()
        time.sleep(max(0.0, 0.5 * seconds))
        ended_s = time.monotonic()
        ticks, lags = watched.figures()
        sender.terminate()
        sender.wait(10.0)
    rows = disturbed(
        f"goal of {points} points, {rate_hz} Hz",
        pace(ticks, watched.began_s, began_s),
        pace(ticks, began_s, ended_s),
        lags,
        f"answer after {answered_s - began_s:.2f} s",
    )
    print(answer, file=sys.stderr)
    return rows


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=8.0)
    parser.add_argument("--rate", type=int, default=100)
    parser.add_argument("--subscribers", type=int, default=20)
    parser.add_argument("--points", type=int, default=100_000)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--only", choices=["subscribers", "goal"])
    arguments = parser.parse_args()
    rows = []
    for _ in range(arguments.runs):
        if arguments.only != "goal":
            rows += subscribers(arguments.subscribers, arguments.seconds, arguments.rate)
        if arguments.only != "subscribers":
            rows += large_goal(arguments.points, arguments.seconds, arguments.rate)
    harness.print_table(f"Busy process ({harness.machine()})", rows)


if __name__ == "__main__":
    main()
