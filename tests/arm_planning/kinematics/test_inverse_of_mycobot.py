"""Inverse kinematics of the myCobot 280 beside what its collision check says."""

import itertools

import numpy as np
import pytest
from planning_models import mycobot, neighbours

from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.model import CollisionModel
from arm_planning.kinematics.inverse import InverseKinematics
from arm_planning.robot.model import PlanningModel
from arm_planning.scene.scene import PlanningScene

HELLO_MOVEIT = RigidTransform((0.061, -0.176, 0.168), (1.0, 0.0, 0.0, 0.0))
"""The goal of the tutorials' first program."""


@pytest.fixture(scope="module")
def model() -> PlanningModel:
    return mycobot()


@pytest.fixture(scope="module")
def kinematics(model) -> InverseKinematics:
    return InverseKinematics(model, "arm")


def test_it_finds_every_pose_of_the_arm(kinematics):
    random = np.random.default_rng(0)
    lower, upper = kinematics.group.lower, kinematics.group.upper
    for _ in range(200):
        target = kinematics.pose(random.uniform(lower, upper))
        found = kinematics.solve(target, random.uniform(lower, upper))
        assert kinematics.pose(found) == pytest.approx(target, abs=1.5e-4)
        assert (lower <= found).all()
        assert (found <= upper).all()


def test_the_goal_of_the_tutorials_is_reached_from_home(kinematics):
    found = kinematics.solve(HELLO_MOVEIT, np.zeros(6))
    reached = kinematics.tip_pose(found)
    assert reached.position == pytest.approx(HELLO_MOVEIT.position, abs=1e-5)


def test_its_collision_check_chooses_the_branch(model, kinematics):
    positions = dict.fromkeys(model.joints, 0.0)
    scene = PlanningScene(positions, allowed=neighbours(model))
    checker = CollisionModel(model, scene, "arm")
    random = np.random.default_rng(1)
    lower, upper = kinematics.group.lower, kinematics.group.upper
    states = (random.uniform(lower, upper) for _ in range(1000))
    in_collision = 0
    for state in itertools.islice(filter(checker.is_free, states), 30):
        target, seed = kinematics.pose(state), random.uniform(lower, upper)
        in_collision += not checker.is_free(kinematics.solve(target, seed))
        assert checker.is_free(kinematics.solve(target, seed, free=checker.is_free))
    assert in_collision
