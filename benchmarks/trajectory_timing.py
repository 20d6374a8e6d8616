"""Times of joint paths beside toppra's, in one process, in turns.

    pip install toppra==0.6.10
    python benchmarks/trajectory_timing.py

Both are asked for the same limits, and both answers are looked at every millisecond. toppra gets
two paths: the cubic spline through the way points, as its users do, and the path with rounded
corners that the suite drives. Its parametrizer is ParametrizeConstAccel, which keeps to the limits
best. Times are the processor times of the thread, the least of three runs of each path.
"""

# toppra is installed for this script alone, and has no types.
# pyright: reportMissingImports=false, reportUntypedBaseClass=false

import argparse
import logging
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import harness
import numpy as np
import toppra
from toppra import algorithm, constraint, interpolator

from arm_planning.robot.model import PlanningLimits
from arm_planning.timing.driven_spline import DrivenSpline
from arm_planning.timing.parameterize import PATH_TOLERANCE, parameterize
from arm_planning.timing.rounded_path import RoundedPath, rounded_paths

VELOCITY, ACCELERATION = 2.79, 3.0
JOINTS = 6
HELD = 1.001
"""Largest part of a limit at which it counts as held."""


@dataclass(frozen=True)
class Answer:
    """A timed path: processor time, duration, and the largest part of each limit that it uses."""

    work_s: float
    duration_s: float
    velocity: float
    acceleration: float

    @property
    def holds(self) -> bool:
        return max(self.velocity, self.acceleration) <= HELD


class Rounded(interpolator.AbstractGeometricPath):
    """A rounded path as toppra wants it, by its distance from the start."""

    def __init__(self, path: RoundedPath) -> None:
        self._path = path
        self._ends = np.cumsum(path.lengths)

    @property
    def dof(self) -> int:
        return self._path.starts.shape[1]

    @property
    def path_interval(self) -> np.ndarray:
        return np.array([0.0, self._ends[-1]])

    @property
    def waypoints(self) -> None:
        return None

    def __call__(self, distance: np.ndarray, order: int = 0) -> np.ndarray:
        piece = np.searchsorted(self._ends, distance, side="right").clip(max=len(self._ends) - 1)
        along = distance - (self._ends - self._path.lengths)[piece]
        rows = (self._path.positions, self._path.tangents, self._path.bends)
        return rows[order](np.asarray(piece), np.asarray(along))

    def grid(self, parts: int) -> np.ndarray:
        """Return the ends of the pieces, and points within."""
        edges = np.concatenate(([0.0], self._ends))
        inner = np.linspace(0.0, self._ends[-1], parts)
        # Points that are closer than this make toppra's linear programs degenerate.
        far = np.abs(inner[:, None] - edges).min(axis=1) > 1e-4
        return np.sort(np.concatenate((edges, inner[far])))


def worked(job: Callable[[], Any]) -> tuple[Any, float]:
    """Return what a job returns, and the least processor time of three runs."""
    times: list[float] = []
    found = None
    for _ in range(3):
        before = time.thread_time()
        found = job()
        times.append(time.thread_time() - before)
    return found, min(times)


def own(points: np.ndarray) -> Answer:
    """Time a path with the suite."""
    limits = [PlanningLimits(-np.pi, np.pi, VELOCITY, ACCELERATION)] * JOINTS
    joints = [f"j{number}" for number in range(JOINTS)]
    found, work_s = worked(lambda: parameterize(points, limits, joints=joints))
    times = np.arange(0.0, found.duration_s, 1e-3)
    _, velocities, accelerations = DrivenSpline.of(found).sample(times)
    return Answer(
        work_s,
        found.duration_s,
        np.abs(velocities).max() / VELOCITY,
        np.abs(accelerations).max() / ACCELERATION,
    )


def peer(path: interpolator.AbstractGeometricPath, grid: np.ndarray) -> Answer | None:
    """Time a path with toppra; None if it fails."""
    limit = np.full((JOINTS, 1), 1.0) * (-1.0, 1.0)
    constraints = [
        constraint.JointVelocityConstraint(VELOCITY * limit),
        constraint.JointAccelerationConstraint(ACCELERATION * limit),
    ]

    def solved() -> Any:
        solver = algorithm.TOPPRA(
            constraints, path, gridpoints=grid, parametrizer="ParametrizeConstAccel"
        )
        return solver.compute_trajectory(0, 0)

    found, work_s = worked(solved)
    if found is None:
        return None
    times = np.arange(0.0, found.duration, 1e-3)
    return Answer(
        work_s,
        found.duration,
        np.abs(found(times, 1)).max() / VELOCITY,
        np.abs(found(times, 2)).max() / ACCELERATION,
    )


def smooth(count: int, rng: np.random.Generator) -> np.ndarray:
    """Return way points on a smooth curve, (count, JOINTS)."""
    turn = 2.0 * np.pi * np.linspace(0.0, 1.0, count)[:, None] * rng.uniform(0.3, 1.0, JOINTS)
    return np.sin(turn + rng.uniform(0.0, 2.0 * np.pi, JOINTS)) * rng.uniform(0.5, 1.5, JOINTS)


def zigzag(count: int, rng: np.random.Generator) -> np.ndarray:
    """Return random way points, 0.7 rad from one to the next in the mean."""
    return rng.uniform(-0.35, 0.35, (count, JOINTS))


def by_spline(points: np.ndarray, parts: int) -> Answer | None:
    """Time the cubic spline through the points with toppra."""
    at = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))))
    path = interpolator.SplineInterpolator(at, points)
    return peer(path, np.linspace(0.0, at[-1], parts + 1))


def by_rounded(points: np.ndarray, parts: int) -> Answer | None:
    """Time the path that the suite drives with toppra."""
    path = Rounded(rounded_paths(points, np.full(len(points), PATH_TOLERANCE))[0])
    return peer(path, path.grid(parts))


def compared(name: str, points: list[np.ndarray]) -> list[harness.Row]:
    """Time some paths by all ways in turns."""
    ways = {
        "cubic spline, 100 parts": lambda path: by_spline(path, 100),
        "cubic spline, 1000 parts": lambda path: by_spline(path, 1000),
        "the same rounded path, 1000 parts": lambda path: by_rounded(path, 1000),
    }
    own(points[0])
    mine: list[Answer] = []
    theirs: dict[str, list[Answer | None]] = {way: [] for way in ways}
    for path in points:
        mine.append(own(path))
        for way, answer in ways.items():
            theirs[way].append(answer(path))
    rows = [harness.Row(f"{name}: the suite", _told(mine), "10 ms; 1.001")]
    for way, answers in theirs.items():
        found = [each for each in answers if each is not None]
        ratios = [
            ours.duration_s / each.duration_s
            for ours, each in zip(mine, answers, strict=True)
            if each is not None and each.holds
        ]
        ratio = (
            f"there the suite's duration is {statistics.median(ratios):.3f} x, "
            f"largest {max(ratios):.3f} x"
            if ratios
            else "it never holds them"
        )
        rows.append(
            harness.Row(
                f"{name}: toppra, {way}",
                f"{_told(found)}; holds the limits in {len(ratios)} of {len(answers)}; {ratio}",
                "1.02 x",
            )
        )
    return rows


def _told(answers: list[Answer]) -> str:
    works = [each.work_s * 1e3 for each in answers]
    return (
        f"{statistics.median(works):.1f} ms (largest {max(works):.1f}), duration "
        f"{statistics.median(each.duration_s for each in answers):.2f} s, largest part of the "
        f"velocity limit {max(each.velocity for each in answers):.4f}, "
        f"of the acceleration limit {max(each.acceleration for each in answers):.4f}"
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=20, help="paths of each kind")
    count = parser.parse_args().count
    logging.getLogger("toppra").setLevel(logging.CRITICAL)
    toppra.setup_logging("ERROR")
    rng = np.random.default_rng(1)
    rows = [
        row
        for name, make, points in (
            ("30 smooth", smooth, 30),
            ("100 smooth", smooth, 100),
            ("5 zigzag", zigzag, 5),
            ("100 zigzag", zigzag, 100),
        )
        for row in compared(f"{name} way points", [make(points, rng) for _ in range(count)])
    ]
    harness.print_table("Timing of joint paths (n each: median)", rows)


if __name__ == "__main__":
    main()
