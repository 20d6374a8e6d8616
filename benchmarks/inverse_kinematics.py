"""Inverse kinematics of the myCobot 280 and of made-up arms of 4 to 7 joints, beside TRAC-IK.

Random reachable poses, each from a random seed; both solvers get the same ones, in turns of 50,
with 50 ms for each. A pose counts as found within 1e-4 m and 1e-3 rad, inside the limits to 1e-6
rad (TRAC-IK's Python package keeps limits as float32). The peer is measured where it is installed:

    pip install pytracik==0.0.3
    python benchmarks/inverse_kinematics.py

Without its own core, run it at a real-time priority: `chrt -f 80 python ...`.
"""

import argparse
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import harness
import numpy as np

from arm_description import expand_xacro, parse_urdf, resolve_uri
from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import PlanningError
from arm_planning.kinematics.inverse import InverseKinematics
from arm_planning.kinematics.search import Orientation
from arm_planning.planners.cartesian import cartesian_path

try:
    import pytracik
except ImportError:
    pytracik = None

AXES = {4: "zyyy", 5: "zyyyx", 6: "zyyxyx", 7: "zyzyzyz"}
VECTORS = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}
LENGTHS_M = (0.1, 0.2, 0.25, 0.2, 0.15, 0.1, 0.1, 0.08)
LIMIT_RAD = 2.8
MYCOBOT = "package://mycobot_description/urdf/robots/mycobot_280.urdf.xacro"
MYCOBOT_JOINTS = (
    "link1_to_link2",
    "link2_to_link3",
    "link3_to_link4",
    "link4_to_link5",
    "link5_to_link6",
    "link6_to_link6_flange",
)
TIMEOUT_S = 0.05
TURN = 50
WITHIN_M, WITHIN_RAD, WITHIN_LIMIT = 1e-4, 1e-3, 1e-6

Solver = Callable[[np.ndarray, np.ndarray], np.ndarray | None]


@dataclass(frozen=True, slots=True)
class Arm:
    name: str
    urdf: str
    joints: tuple[str, ...]
    base: str
    tip: str


@dataclass(slots=True)
class Score:
    found: int = 0
    times_ms: list[float] = field(default_factory=list)


def made_up(size: int) -> Arm:
    """Return an arm of turning joints whose tool stands at an angle."""
    parts = [f"<link name='l{n}'/>" for n in range(size + 2)]
    for n, axis in enumerate(AXES[size]):
        parts.append(
            f"<joint name='j{n}' type='revolute'><parent link='l{n}'/><child link='l{n + 1}'/>"
            f"<origin xyz='0 0 {LENGTHS_M[n]}'/><axis xyz='{VECTORS[axis]}'/>"
            f"<limit lower='{-LIMIT_RAD}' upper='{LIMIT_RAD}' effort='1' velocity='1'/></joint>"
        )
    parts.append(
        f"<joint name='tool' type='fixed'><parent link='l{size}'/><child link='l{size + 1}'/>"
        "<origin xyz='0.02 0 0.1' rpy='0.1 0.2 0.3'/></joint>"
    )
    joints = tuple(f"j{n}" for n in range(size))
    urdf = f"<robot name='arm{size}'>{''.join(parts)}</robot>"
    return Arm(f"{size} joints", urdf, joints, "l0", f"l{size + 1}")


def arms() -> list[Arm]:
    urdf = expand_xacro(resolve_uri(MYCOBOT))
    mycobot = Arm("myCobot 280", urdf, MYCOBOT_JOINTS, parse_urdf(urdf).root, "gripper_base")
    return [mycobot, *(made_up(size) for size in AXES)]


def wxyz(rotation: np.ndarray) -> np.ndarray:
    """Return the quaternion of a rotation, from the eigenvector of Bar-Itzhack's matrix."""
    (a, b, c), (d, e, f), (g, h, i) = rotation
    matrix = [
        [a - e - i, b + d, c + g, h - f],
        [b + d, e - a - i, f + h, c - g],
        [c + g, f + h, i - a - e, d - b],
        [h - f, c - g, d - b, a + e + i],
    ]
    x, y, z, w = np.linalg.eigh(np.array(matrix) / 3.0)[1][:, -1]
    return np.array([w, x, y, z])


def ours(kinematics: InverseKinematics) -> Solver:
    def solve(target: np.ndarray, seed: np.ndarray) -> np.ndarray | None:
        try:
            return kinematics.solve(target, seed, timeout_s=TIMEOUT_S)
        except PlanningError:
            return None

    return solve


def peer(arm: Arm) -> Solver:
    solver = pytracik.TRAC_IK(
        arm.base, arm.tip, arm.urdf, TIMEOUT_S, 1e-5, pytracik.SolveType.Speed
    )

    def solve(target: np.ndarray, seed: np.ndarray) -> np.ndarray | None:
        w, x, y, z = wxyz(target[:3, :3])
        answer = pytracik.ik(solver, seed, *target[:3, 3], x, y, z, w)
        return np.array(answer[1:]) if answer[0] >= 0 else None

    return solve


def is_right(kinematics: InverseKinematics, target: np.ndarray, q: np.ndarray | None) -> bool:
    if q is None or np.isnan(q).any():
        return False
    group = kinematics.group
    inside = (q >= group.lower - WITHIN_LIMIT).all() and (q <= group.upper + WITHIN_LIMIT).all()
    pose = kinematics.pose(np.clip(q, group.lower, group.upper))
    cosine = (np.trace(pose[:3, :3].T @ target[:3, :3]) - 1.0) / 2.0
    sine = np.linalg.norm(pose[:3, :3] - target[:3, :3]) / np.sqrt(8.0)
    angle = 2.0 * np.arcsin(min(sine, 1.0)) if cosine > -0.5 else np.pi
    near = np.linalg.norm(pose[:3, 3] - target[:3, 3]) < WITHIN_M
    return bool(inside and near and angle < WITHIN_RAD)


def race(arm: Arm, count: int) -> tuple[Score, Score | None]:
    """Return what this suite and the peer find, and in what time."""
    kinematics = InverseKinematics.for_link(parse_urdf(arm.urdf), arm.tip, arm.joints)
    solvers = [ours(kinematics)]
    if pytracik is not None:
        solvers.append(peer(arm))
    scores = [Score() for _ in solvers]
    random = np.random.default_rng(1)
    lower, upper = kinematics.group.lower, kinematics.group.upper
    for solver in solvers:
        solver(kinematics.pose(np.zeros(len(lower))), random.uniform(lower, upper))
    for _ in range(count // TURN):
        poses = [
            (kinematics.pose(random.uniform(lower, upper)), random.uniform(lower, upper))
            for _ in range(TURN)
        ]
        for solver, score in zip(solvers, scores, strict=True):
            for target, seed in poses:
                before = time.perf_counter()
                q = solver(target, seed)
                score.times_ms.append((time.perf_counter() - before) * 1e3)
                score.found += is_right(kinematics, target, q)
    return scores[0], scores[1] if len(scores) > 1 else None


def text(score: Score | None) -> str:
    if score is None:
        return "not installed"
    p50, p99 = harness.percentiles(score.times_ms, 50, 99)
    return f"{100.0 * score.found / len(score.times_ms):.1f} %; {p50:.2f} / {p99:.1f} ms"


def median_ms(call: Callable[[np.ndarray, np.ndarray], object], poses: Sequence) -> str:
    times = []
    for target, seed in poses:
        before = time.perf_counter()
        call(target, seed)
        times.append((time.perf_counter() - before) * 1e3)
    return f"{np.median(times):.1f} ms"


def others(count: int) -> list[harness.Row]:
    """Return how long the other questions take."""
    arm = made_up(5)
    five = InverseKinematics.for_link(parse_urdf(arm.urdf), arm.tip, arm.joints)
    arm = made_up(7)
    seven = InverseKinematics.for_link(parse_urdf(arm.urdf), arm.tip, arm.joints)
    random = np.random.default_rng(2)

    def poses(kinematics: InverseKinematics) -> list[tuple[np.ndarray, np.ndarray]]:
        size = len(kinematics.group.joints)
        draw = [random.uniform(-LIMIT_RAD, LIMIT_RAD, (2, size)) for _ in range(count)]
        return [(kinematics.pose(q), seed) for q, seed in draw]

    turned = [(a @ seven.pose(np.ones(7)), seed) for a, seed in poses(five)]
    turned = [
        (np.vstack([np.column_stack([t[:3, :3], a[:3, 3]]), t[3:]]), seed)
        for (t, seed), (a, _) in zip(turned, poses(five), strict=True)
    ]
    near = [(seven.pose(seed + 0.02), seed) for _, seed in poses(seven)]
    far = [(a + np.array([[0.0] * 3 + [3.0]] + [[0.0] * 4] * 3), seed) for a, seed in poses(seven)]

    def refused(target: np.ndarray, seed: np.ndarray) -> None:
        try:
            seven.solve(target, seed)
        except PlanningError:
            return
        raise AssertionError("a pose beyond the arm's length was reached")

    def nearest(target: np.ndarray, seed: np.ndarray) -> object:
        return five.solve(target, seed, orientation=Orientation.NEAREST)

    arm = arms()[0]
    mycobot = InverseKinematics.for_link(parse_urdf(arm.urdf), arm.tip, arm.joints)
    ready = np.array([0.0, 0.0, 1.57, 1.57, 0.0, 0.0])
    x, y, z = mycobot.tip_pose(ready).position
    down = RigidTransform((x, y, z - 0.1), mycobot.tip_pose(ready).rotation)

    def straight(target: RigidTransform, seed: np.ndarray) -> None:
        path = cartesian_path(mycobot, seed, [target], 0.0025)
        assert path.fraction == 1.0
        assert len(path.points) >= 41

    return [
        harness.Row(
            "myCobot 280, a straight path of 100 mm in steps of 2.5 mm",
            median_ms(straight, [(down, ready)] * count),
        ),
        harness.Row("7 joints, `follow` a pose next to the seed's", median_ms(seven.follow, near)),
        harness.Row("7 joints, the nearest of `solutions`", median_ms(seven.solutions, near)),
        harness.Row("7 joints, a pose beyond the arm's length is refused", median_ms(refused, far)),
        harness.Row("5 joints, any orientation, the nearest is found", median_ms(nearest, turned)),
    ]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--poses", type=int, default=1000)
    arguments = parser.parse_args()
    rows = []
    for arm in arms():
        here, there = race(arm, arguments.poses)
        rows += [
            harness.Row(f"{arm.name}: found; p50 / p99", text(here), "99.9 %; TRAC-IK; 10 ms"),
            harness.Row(f"{arm.name}: pytracik, Speed", text(there)),
        ]
    rows += others(100)
    harness.print_table("Inverse kinematics", rows)


if __name__ == "__main__":
    main()
