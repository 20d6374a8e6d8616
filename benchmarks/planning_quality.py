"""What plans are worth, and what a change of a large scene costs.

    pip install ompl==2.0.1
    python benchmarks/planning_quality.py [--problems 3] [--runs 20] [--seconds 10] [--parts solved]

* A problem that the suite does not solve within a second counts as solvable if it, or OMPL's
  RRTConnect, solves it within 30 s.
* Ten processes plan the same problems with the same seeds at the same time: the paths must be equal
  to the bit.
* RRT* of OMPL, on the same MuJoCo check, improves a path for some seconds of processor time,
  several times: the suite's paths are compared with its shortest, problem by problem.
* A scene of the myCobot and 100 different meshes changes; states in which nothing touches are
  checked in it, and without the meshes.

Times are processor times of the thread.
"""

import argparse
import hashlib
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import replace

import harness
import numpy as np
import ompl.base
import ompl.geometric
import ompl.util
from planning import ompl_setup, ours, peer
from planning_problems import GROUP, SCENES, Arm, Cell, arms, cell

from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.collision.model import CollisionModel
from arm_planning.planners.problem import path_length
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import TriangleMesh

PROCESSES = 10
PATIENT_S = 5.0
LAST_S = 30.0
PARTS = ("scenes", "equal", "solved", "lengths")
MESHES = 100
REPEATS = 50
CHECKED = 2000


def cells(count: int, only: str) -> Iterator[tuple[Cell, CollisionModel]]:
    for arm in arms():
        for kind in SCENES:
            if only in f"{arm.name}, {kind}":
                given = cell(arm, kind, count)
                yield given, CollisionModel(arm.model, given.scene, GROUP)


def digest(count: int) -> str:
    """Return a digest of the bits of all paths of problems of each arm and scene.

    The planner has as long as it needs: less time than that gives no path, never another one.
    """
    found = hashlib.blake2b()
    for given, model in cells(count, ""):
        plan = ours(given, model, PATIENT_S)
        for seed, (start, goal) in enumerate(given.problems):
            path = plan(start, goal, seed)
            found.update(b"none" if path is None else path.tobytes())
    return found.hexdigest()


def equal_in_processes(count: int) -> harness.Row:
    command = [sys.executable, __file__, "--digest", str(count)]
    started = [
        subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(PROCESSES)
    ]
    digests = {process.communicate()[0].strip() for process in started}
    problems = count * len(arms()) * len(SCENES)
    return harness.Row(
        f"different sets of paths of {PROCESSES} processes at a time, {problems} problems",
        str(len(digests)),
        "1",
    )


def shortest(
    given: Cell,
    model: CollisionModel,
    start: np.ndarray,
    goal: np.ndarray,
    runs: int,
    limit_s: float,
) -> float:
    """Return the length of RRT*'s shortest path of some runs; infinite if there is none."""
    best = np.inf
    for run in range(runs):
        ompl.util.RNG.setSeed(run + 1)
        setup = ompl_setup(given, model, start, goal)
        setup.setPlanner(ompl.geometric.RRTstar(setup.getSpaceInformation()))
        end_s = time.process_time() + limit_s
        setup.solve(
            ompl.base.PlannerTerminationCondition(lambda end_s=end_s: time.process_time() > end_s)
        )
        if setup.haveExactSolutionPath():
            best = min(best, setup.getSolutionPath().length())
    return best


def solved(count: int, only: str) -> harness.Row:
    solved = solvable = 0
    for given, model in cells(count, only):
        plan = ours(given, model)
        patient = ours(given, model, LAST_S), peer(given, model, LAST_S)
        for seed, (start, goal) in enumerate(given.problems):
            is_solved = plan(start, goal, seed) is not None
            solved += is_solved
            solvable += is_solved or any(each(start, goal, seed) is not None for each in patient)
    return harness.Row(
        f"{only or 'all'}: solved within 1 s, of what anything solves within {LAST_S:g} s",
        f"{solved} of {solvable}",
        "99.5 %",
    )


def lengths(count: int, runs: int, limit_s: float, only: str) -> harness.Row:
    ratios: list[float] = []
    for given, model in cells(count, only):
        plan = ours(given, model)
        for seed, (start, goal) in enumerate(given.problems):
            path = plan(start, goal, seed)
            best = shortest(given, model, start, goal, runs, limit_s)
            if path is not None and np.isfinite(best):
                ratios.append(path_length(path) / best)
                # Hours may pass until the last: what is known so far is not lost with the rest.
                print(f"{given.arm.name}, {given.kind}, {seed}: {ratios[-1]:.3f} x", flush=True)
    p50, p90 = harness.percentiles(ratios, 50, 90) if ratios else (np.nan, np.nan)
    return harness.Row(
        f"{only or 'all'}: length against the shortest of {runs} runs of RRT* of {limit_s:g} s, "
        f"{len(ratios)} problems: p50 / p90",
        f"{p50:.2f} / {p90:.2f} x",
        "p50 1.1 x",
    )


def meshes(arm: Arm, random: np.random.Generator) -> dict[str, CollisionObject]:
    """Return different meshes around an arm, out of its way."""
    found: dict[str, CollisionObject] = {}
    while len(found) < MESHES:
        x, y, z = random.uniform(-1.5, 1.5, 3) * arm.reach_m
        if np.hypot(x, y) > 0.6 * arm.reach_m:
            name = f"mesh{len(found)}"
            pose = RigidTransform((float(x), float(y), float(z)))
            found[name] = CollisionObject(name, pose, (PlacedShape(_stone(random)),))
    return found


def _stone(random: np.random.Generator) -> TriangleMesh:
    """Return a ball of some 6 cm with 62 corners, stretched by chance."""
    up, around = np.linspace(0.0, np.pi, 7)[1:-1], np.arange(12) * (np.pi / 6.0)
    rings = np.array(
        [[np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)] for a in up for b in around]
    )
    corners = np.vstack([rings, [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]])
    faces = [[60, n, (n + 1) % 12] for n in range(12)]
    faces += [[61, 48 + (n + 1) % 12, 48 + n] for n in range(12)]
    for ring in range(4):
        for n in range(12):
            a, b = 12 * ring + n, 12 * ring + (n + 1) % 12
            faces += [[a, a + 12, b], [b, a + 12, b + 12]]
    return TriangleMesh(corners * random.uniform(0.02, 0.04, 3), np.array(faces))


def large_scene() -> list[harness.Row]:
    arm, random, pieces = arms()[0], np.random.default_rng(0), MeshPieces()
    positions = dict.fromkeys(arm.model.joints, 0.0)
    empty = PlanningScene(positions, allowed=arm.allowed)
    scene = replace(empty, objects=meshes(arm, random))
    first = CollisionModel(arm.model, scene, GROUP, pieces)
    moved = replace(scene.objects["mesh5"], pose=RigidTransform((0.3, 0.2, 0.4)))
    new = replace(scene.objects["mesh6"], id="new", shapes=(PlacedShape(_stone(random)),))
    changes = {
        "nothing is known": (scene, None),
        "one more": (replace(scene, objects={**scene.objects, "new": new}), first),
        "one moved": (replace(scene, objects={**scene.objects, "mesh5": moved}), first),
    }
    times_ms = [
        _median_ms(lambda s=s, like=like: CollisionModel(arm.model, s, GROUP, pieces, like))
        for s, like in changes.values()
    ]
    alone = CollisionModel(arm.model, empty, GROUP, pieces)
    group = arm.model.group(GROUP)
    states = random.uniform(group.lower, group.upper, (CHECKED, len(group.joints)))
    states = np.array([q for q in states if first.is_free(q)])
    full_ms, empty_ms = (
        _median_ms(lambda model=model: [model.is_free(q) for q in states])
        for model in (first, alone)
    )
    box = new, replace(new, pose=moved.pose)
    one, other = (replace(empty, objects={"new": each}) for each in box)
    small = (empty, None), (one, alone), (other, CollisionModel(arm.model, one, GROUP, pieces))
    small_ms = [
        _median_ms(lambda s=s, like=like: CollisionModel(arm.model, s, GROUP, pieces, like))
        for s, like in small
    ]
    return [
        harness.Row(
            f"scene of {MESHES} meshes, a change: {', '.join(changes)}",
            ", ".join(f"{time_ms:.1f}" for time_ms in times_ms) + " ms",
            "5 ms",
        ),
        harness.Row(
            "a check in it, of one in the empty scene", f"{full_ms / empty_ms:.1f} x", "3 x"
        ),
        harness.Row(
            "the myCobot alone: nothing is known, one mesh more, that one moved",
            ", ".join(f"{time_ms:.1f}" for time_ms in small_ms) + " ms",
            "0.5 ms",
        ),
    ]


def _median_ms(call: Callable[[], object]) -> float:
    times: list[float] = []
    for _ in range(REPEATS):
        began_s = time.thread_time()
        call()
        times.append(1e3 * (time.thread_time() - began_s))
    return float(np.median(times))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--problems", type=int, default=3, help="for each arm and scene")
    parser.add_argument("--runs", type=int, default=20, help="runs of RRT* for each problem")
    parser.add_argument("--seconds", type=float, default=10.0, help="processor time of each run")
    parser.add_argument("--only", default="", help="part of the names of arms and scenes")
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=PARTS)
    parser.add_argument("--digest", type=int, default=0, help=argparse.SUPPRESS)
    options = parser.parse_args()
    ompl.util.noOutputHandler()
    if options.digest:
        print(digest(options.digest))
        return
    print(harness.machine())
    count, only = options.problems, options.only
    parts: dict[str, Callable[[], list[harness.Row]]] = {
        "scenes": large_scene,
        "equal": lambda: [equal_in_processes(count)],
        "solved": lambda: [solved(count, only)],
        "lengths": lambda: [lengths(count, options.runs, options.seconds, only)],
    }
    rows = [row for part in options.parts for row in parts[part]()]
    harness.print_table("Worth of plans, and large scenes", rows)


if __name__ == "__main__":
    main()
