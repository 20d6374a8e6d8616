"""The suite's planner beside OMPL's RRTConnect with `simplifySolution` and MoveIt's fraction.

    pip install ompl==2.0.1
    python benchmarks/planning.py [--count 200] [--only shelf]

Both get the same problems of `planning_problems.py` in turn, with the same MuJoCo check. Times are
processor times, because the machine may be busy; ours include the proof, the peer's have none. A
returned path counts as colliding if a state on it does, looked at every 0.001 rad. A problem counts
as solvable if either of the two solves it. Lengths are compared where both solve it.
"""

import argparse
import itertools
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import harness
import numpy as np
import ompl.base
import ompl.geometric
import ompl.util
from planning_problems import GROUP, SCENES, Cell, arms, cell

from arm_planning.collision.model import CollisionModel
from arm_planning.collision.motion_proof import MotionProof
from arm_planning.errors import PlanningError
from arm_planning.planners.problem import Deadline, PlanningProblem, path_length
from arm_planning.planners.search import RrtConnectPlanner

LIMIT_S = 1.0
FRACTION = 0.005
LOOK_RAD = 0.001

Plan = Callable[[np.ndarray, np.ndarray, int], np.ndarray | None]


class Checker:
    """The collision check of a scene and the proof of motions, for the planner."""

    def __init__(self, model: CollisionModel) -> None:
        proof = MotionProof(model)
        self.is_free, self.contacts = model.is_free, model.contacts
        self.free_count = model.free_count
        self.is_free_edge, self.prove = proof.is_free_edge, proof.prove


@dataclass(frozen=True, slots=True)
class OneGoal:
    """A goal that is one state."""

    state: np.ndarray

    def nearest(self) -> tuple[np.ndarray, ...]:
        return (self.state,)

    def all(self) -> tuple[np.ndarray, ...]:
        return (self.state,)


@dataclass(slots=True)
class Score:
    """What one planner did in one cell; a time and a length for each problem."""

    times_ms: list[float] = field(default_factory=list)
    lengths: list[float] = field(default_factory=list)
    colliding: int = 0

    @property
    def solved(self) -> np.ndarray:
        return np.isfinite(self.lengths)


def ours(given: Cell, model: CollisionModel, limit_s: float = LIMIT_S) -> Plan:
    checker, group = Checker(model), given.arm.model.group(GROUP)

    def plan(start: np.ndarray, goal: np.ndarray, seed: int) -> np.ndarray | None:
        deadline = Deadline(time.process_time() + limit_s, time.process_time)
        problem = PlanningProblem(
            group, start, OneGoal(goal), checker, deadline=deadline, seed=seed
        )
        try:
            return RrtConnectPlanner().plan(problem)
        except PlanningError:
            return None

    return plan


def ompl_setup(
    given: Cell, model: CollisionModel, start: np.ndarray, goal: np.ndarray
) -> ompl.geometric.SimpleSetup:
    """Return a problem for OMPL's planners, with MoveIt's fraction."""
    group = given.arm.model.group(GROUP)
    count = len(group.joints)
    space = ompl.base.RealVectorStateSpace(count)
    bounds = ompl.base.RealVectorBounds(count)
    for index, limits in enumerate(group.limits):
        bounds.setLow(index, limits.lower)
        bounds.setHigh(index, limits.upper)
    space.setBounds(bounds)
    space.setLongestValidSegmentFraction(FRACTION)
    setup = ompl.geometric.SimpleSetup(space)
    setup.setStateValidityChecker(lambda state: model.is_free(np.array(state[0:count])))
    first, last = space.allocState(), space.allocState()
    first[0:count], last[0:count] = start.tolist(), goal.tolist()
    setup.setStartAndGoalStates(first, last)
    return setup


def peer(given: Cell, model: CollisionModel, limit_s: float = LIMIT_S) -> Plan:
    count = len(given.arm.model.group(GROUP).joints)

    def plan(start: np.ndarray, goal: np.ndarray, seed: int) -> np.ndarray | None:
        ompl.util.RNG.setSeed(seed + 1)
        setup = ompl_setup(given, model, start, goal)
        setup.setPlanner(ompl.geometric.RRTConnect(setup.getSpaceInformation()))
        end_s = time.process_time() + limit_s
        setup.solve(ompl.base.PlannerTerminationCondition(lambda: time.process_time() > end_s))
        if not setup.haveExactSolutionPath():
            return None
        setup.simplifySolution()
        path = setup.getSolutionPath()
        return np.array([path.getState(i)[0:count] for i in range(path.getStateCount())])

    return plan


def collides(model: CollisionModel, path: np.ndarray) -> bool:
    for a, b in itertools.pairwise(path):
        count = int(np.ceil(np.abs(b - a).max() / LOOK_RAD)) + 1
        if not all(model.is_free(a + part * (b - a)) for part in np.linspace(0.0, 1.0, count)):
            return True
    return False


def measure(given: Cell) -> tuple[Score, Score]:
    model = CollisionModel(given.arm.model, given.scene, GROUP)
    planners = (ours(given, model), peer(given, model))
    scores = (Score(), Score())
    for seed, (start, goal) in enumerate(given.problems):
        for plan, score in zip(planners, scores, strict=True):
            began_s = time.process_time()
            path = plan(start, goal, seed)
            score.times_ms.append(1e3 * (time.process_time() - began_s))
            score.lengths.append(np.nan if path is None else path_length(path))
            score.colliding += path is not None and collides(model, path)
    return scores


def row(given: Cell, scores: tuple[Score, Score]) -> harness.Row:
    solvable = scores[0].solved | scores[1].solved
    texts = []
    for score in scores:
        times = np.array(score.times_ms)[solvable]
        p50, p99 = harness.percentiles(times, 50, 99)
        texts.append(
            f"{p50:.1f} / {p99:.1f} ms, {score.solved.sum()} of {solvable.sum()}, "
            f"{score.colliding} colliding"
        )
    both = scores[0].solved & scores[1].solved
    ratio = np.median(np.array(scores[0].lengths)[both] / np.array(scores[1].lengths)[both])
    share = "0.5 x" if given.kind == "free" else "0.7 x"
    return harness.Row(
        f"{given.arm.name}, {given.kind} (n={len(given.problems)})",
        f"{texts[0]}; peer {texts[1]}; length {ratio:.2f} x",
        f"p50 {share}, p99 0.5 x, 99.5 %, 0 colliding",
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=200, help="problems for each arm and scene")
    parser.add_argument("--only", default="", help="part of the names of arms and scenes to run")
    options = parser.parse_args()
    ompl.util.noOutputHandler()
    print(f"{harness.machine()}; p50 / p99 of processor time, solved, colliding paths")
    rows = []
    for arm in arms():
        for kind in SCENES:
            if options.only in f"{arm.name}, {kind}":
                given = cell(arm, kind, options.count)
                rows.append(row(given, measure(given)))
    harness.print_table("Plans, beside OMPL's RRTConnect", rows)


if __name__ == "__main__":
    main()
