"""The pick in the simulation, with the controllers that run there, as fast as it goes.

Nothing tells the plan where the cylinder really stands, and nothing but friction holds it: success
is what its pose shows.
"""

import logging
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from arm_control.controllers.goals import GoalOutcome
from arm_controller.arm_gripper_loop_controller_node import run_once
from arm_controller.pick_and_place_node import PickAndPlace, PickError
from arm_controller.pick_plan import JOINTS, JointPath, PickPlan, PickTask, plan_pick
from arm_description import expand_xacro, parse_urdf, resolve_uri
from arm_sim import NAMED_ROBOTS, Goal, JointTrajectory, Simulation

RATE_HZ = 100
ROBOT, OBJECT = "mycobot_280", "red_cylinder"
START = np.array([0.22, 0.12, 0.175])
SPREAD_M = 0.005
RUNS = 8
SEED = 280
LONGEST_S = 30.0
LOOP_S = 2.0
PADS = {"gripper_left1", "gripper_right1"}
LOGGER = logging.getLogger("robot")
ARM, GRIPPER = "arm_controller", "gripper_action_controller"


@pytest.fixture(scope="module")
def description() -> str:
    named = NAMED_ROBOTS["mycobot"]
    return expand_xacro(resolve_uri(named.model), named.arguments)


@pytest.fixture(scope="module")
def links(description) -> frozenset[str]:
    return frozenset(link.name for link in parse_urdf(description).links)


@pytest.fixture(scope="module")
def plan(description) -> PickPlan:
    return plan_pick(description, PickTask())


@dataclass
class Track:
    """What happened in all ticks: where the object was, and what the robot touched.

    Attributes:
        heights: of the object above its start, m.
        tilts: of the object, rad.
        touched: links of the robot, each with a thing that it touched.
    """

    heights: list[float]
    tilts: list[float]
    touched: set[tuple[str, str]]


class SteppedRobot:
    """Stands for `ArmActions`, in the simulation; time passes while it moves.

    Args:
        links: the robot's links.
        offset: of the object from where it stands by default, in m.
    """

    def __init__(self, links: frozenset[str], offset: tuple[float, float] = (0.0, 0.0)) -> None:
        self.sim = Simulation("mycobot")
        if any(offset):
            place = self.sim.pose(OBJECT)
            place[:2, 3] += offset
            self.sim.place(OBJECT, place)
        self._links = links
        self._things = [name for name in self.sim.entities if name != ROBOT]
        self._places = {name: self.sim.pose(name) for name in self._things}
        self.track = Track([], [], set())
        self.during: dict[str, slice] = {}

    def tick(self) -> None:
        self.sim.step()
        pose = self.sim.pose(OBJECT)
        self.track.heights.append(pose[2, 3] - START[2])
        self.track.tilts.append(np.arccos(min(1.0, pose[2, 2])))
        self.track.touched.update(
            (contact.body, contact.other)
            for contact in self.sim.contacts(ROBOT)
            if contact.other not in self._links
        )

    def moved(self) -> set[str]:
        """Return the things that are not where they were: a touch between two ticks shows, too."""
        ways = {n: self.sim.pose(n)[:3, 3] - self._places[n][:3, 3] for n in self._things}
        return {name for name, way in ways.items() if np.linalg.norm(way) > 2e-3}

    @property
    def object_position(self) -> np.ndarray:
        return self.sim.pose(OBJECT)[:3, 3]

    def connect(self) -> None:
        pass

    def follow(self, path: JointPath) -> str | None:
        velocities = [p.velocities for p in path]
        goal = self.sim[ARM].follow(
            JointTrajectory(
                [p.time_s for p in path],
                [p.positions for p in path],
                JOINTS,
                velocities if any(velocities) else None,
            )
        )
        end = self._ended(goal)
        return None if end.outcome is GoalOutcome.SUCCEEDED else end.message

    def grip(self, position: float, max_effort: float) -> SimpleNamespace:
        end = self._ended(self.sim[GRIPPER].grip(position, max_effort))
        return SimpleNamespace(
            position=end.state.position, reached_goal=end.reached_goal, stalled=end.stalled
        )

    def pause(self, seconds: float) -> None:
        before = len(self.track.heights)
        for _ in range(round(seconds * RATE_HZ)):
            self.tick()
        self.during["pause"] = slice(before, len(self.track.heights))

    def _ended(self, goal: Goal[Any]) -> Any:
        end_s = self.sim.time_s + LONGEST_S
        while not goal.done:
            self.tick()
            assert self.sim.time_s < end_s, f"{goal.controller} does not end its goal"
        return goal.end


def offsets() -> list[tuple[float, float]]:
    drawn = np.random.default_rng(SEED).uniform(-SPREAD_M, SPREAD_M, (RUNS - 4, 2))
    corners = [(x, y) for x in (-SPREAD_M, SPREAD_M) for y in (-SPREAD_M, SPREAD_M)]
    return [*corners, *((float(x), float(y)) for x, y in drawn)]


def assert_held_and_put_back(robot: SteppedRobot, task: PickTask) -> None:
    heights = np.array(robot.track.heights[robot.during["pause"]])
    assert len(heights) == task.hold_s * RATE_HZ
    assert heights == pytest.approx(task.lift, abs=2e-3), "it was lifted, and stayed there"
    assert np.ptp(heights) < 5e-4, "it did not slip"
    assert max(robot.track.tilts) < np.radians(5.0), "it never fell"
    assert robot.track.tilts[-1] < np.radians(1.0), "it stands again"
    assert robot.object_position == pytest.approx(START, abs=0.012), "where it stood"
    assert robot.track.touched == {(pad, OBJECT) for pad in PADS}, "nothing else was touched"
    assert robot.moved() <= {OBJECT}


@pytest.mark.parametrize("offset", offsets(), ids=lambda o: f"{o[0] * 1e3:.1f}_{o[1] * 1e3:.1f}mm")
def test_the_cylinder_is_lifted_held_and_put_back_wherever_it_stands(links, plan, offset):
    robot = SteppedRobot(links, offset)
    PickAndPlace(robot, plan, LOGGER).run()
    assert_held_and_put_back(robot, plan.task)


def test_a_hard_grip_holds_as_well(links, plan):
    robot = SteppedRobot(links, (0.003, -0.004))
    hard = replace(plan, task=replace(plan.task, max_effort=8.0))
    PickAndPlace(robot, hard, LOGGER).run()
    assert_held_and_put_back(robot, plan.task)


def test_nothing_but_friction_lifts_it(links, plan):
    robot = SteppedRobot(links)
    robot.sim.parts.physics.model.geom_friction[:, 0] = 0.01
    PickAndPlace(robot, plan, LOGGER).run()
    assert max(robot.track.heights) < 0.01


def test_an_object_that_is_not_there_is_missed(links, plan):
    robot = SteppedRobot(links, (0.0, -0.4))
    with pytest.raises(PickError, match="nothing between the fingers: they closed all the way"):
        PickAndPlace(robot, plan, LOGGER).run()
    assert max(map(abs, robot.track.heights)) < 1e-3


def test_the_loop_of_arm_and_gripper_touches_nothing(links, caplog):
    robot = SteppedRobot(links)
    caplog.clear()
    run_once(robot, LOGGER, LOOP_S, 5.0)
    run_once(robot, LOGGER, LOOP_S, 5.0)
    assert caplog.messages == [], "every place was reached"
    assert robot.track.touched == set()
    assert robot.moved() == set()


def test_a_thing_in_the_way_of_the_loop_is_seen_to_be_hit(links):
    robot = SteppedRobot(links, (-0.48, -0.03))
    run_once(robot, LOGGER, LOOP_S, 5.0)
    assert robot.moved() == {OBJECT}
