"""The task of moving a link of the robot to a point."""

from typing import Any

import numpy as np

from arm_description.urdf.parser import parse_urdf
from arm_planning.kinematics.inverse import InverseKinematics
from arm_planning.kinematics.search import Orientation
from arm_sim.errors import CallError
from arm_sim.gym.arm_env import ArmEnv
from arm_sim.gym.batch_env import BatchEnv
from arm_sim.gym.expert import WayExpert
from arm_sim.gym.task import (
    JOINT_POSITIONS,
    JOINT_VELOCITIES,
    Array,
    Flags,
    Observation,
    Scene,
    Task,
)

TIP = "crawer_base"
"""The link of the 4-DOF arm that carries its gripper."""
TOLERANCE_M = 0.02
RANGE_SHARE = 0.5
"""Goals are where the link is with its joints in this share of their ranges, around zero."""
LOWEST_M, NEAREST_M = 0.1, 0.08
"""How high goals are at least, and how far from the robot's axis."""
TRIES = 1000
FREE_TURN = np.pi
"""Goals of joints that turn without limits are up to half a turn away."""


def reach_task(tip: str = TIP, tolerance_m: float = TOLERANCE_M) -> Task:
    """Return the task of moving a link to a point that the robot can reach.

    Observations are the joints' positions and velocities, the link's position `tip`, and the vector
    `error` from it to the goal, in rad, m and s. The reward is the negative distance in m. An
    episode ends when the distance is within the tolerance.

    Args:
        tip: the link.
        tolerance_m: distance at which the goal is reached.
    """

    def error(scene: Scene) -> Array:
        return scene.goal["point"] - scene.point(tip)

    def distance(scene: Scene) -> Array:
        return np.sqrt((error(scene) ** 2).sum(axis=-1))

    def reached(scene: Scene) -> Flags:
        return distance(scene) <= tolerance_m

    return Task(
        observations={
            "position": JOINT_POSITIONS,
            "velocity": JOINT_VELOCITIES,
            "tip": Observation(lambda scene: scene.point(tip), -10.0, 10.0),
            "error": Observation(error, -10.0, 10.0),
        },
        reward=lambda scene: -distance(scene),
        terminated=reached,
        succeeded=reached,
        start=lambda scene, random: {"point": reachable_point(scene, random, tip)},
    )


def reachable_point(scene: Scene, random: np.random.Generator, tip: str) -> Array:
    """Return a random point that a link can reach, above the floor and away from the robot's axis.

    Args:
        scene: the robot.
        random: the source of joint positions in the middle half of their ranges.
        tip: the link.

    Raises:
        CallError: no such point was found; the link hardly ever is where goals may be.
    """
    lower = np.maximum(scene.lower, -FREE_TURN) * RANGE_SHARE
    upper = np.minimum(scene.upper, FREE_TURN) * RANGE_SHARE
    for _ in range(TRIES):
        point = scene.point_at(tip, random.uniform(lower, upper))
        if point[2] >= LOWEST_M and np.hypot(point[0], point[1]) >= NEAREST_M:
            return point
    raise CallError(
        f"link '{tip}' has no goals: in {TRIES} random poses it was never at least {LOWEST_M:g} m "
        f"above the floor and {NEAREST_M:g} m from the robot's axis"
    )


def reach_expert(env: ArmEnv, tip: str) -> WayExpert:
    """Return an expert that turns all joints straight to positions where the link is at the goal.

    Raises:
        PlanningError: there are no such positions.
    """
    robot = parse_urdf(env.simulation.parts.robot.document)
    kinematics = InverseKinematics.for_link(robot, tip, env.joints)
    # The goal as the robot's root sees it.
    target = kinematics.pose(env.position) @ np.linalg.inv(env.simulation.pose(tip))
    target[:3, 3] += target[:3, :3] @ env.goal["point"]
    return WayExpert([kinematics.solve(target, env.position, orientation=Orientation.ANY)])


class ArmReach(ArmEnv):
    """Move the gripper of the 4-DOF arm, or a link of any robot, to a random point.

    Args:
        description: see `ArmEnv`.
        tip: the link.
        tolerance_m: distance at which the goal is reached.
        actions: see `ArmEnv`.
        expert: whether infos contain the action of inverse kinematics as `expert_action`.
        options: further arguments of `ArmEnv`.
    """

    def __init__(
        self,
        description: str = "arm",
        tip: str = TIP,
        tolerance_m: float = TOLERANCE_M,
        actions: str = "step",
        expert: bool = False,
        **options: Any,
    ) -> None:
        task = reach_task(tip, tolerance_m)
        if expert:
            options["expert"] = lambda env: reach_expert(env, tip)
        super().__init__(description, task, actions=actions, **options)


def reach_batch(
    num_envs: int,
    max_episode_steps: int,
    description: str = "arm",
    tip: str = TIP,
    tolerance_m: float = TOLERANCE_M,
    actions: str = "step",
    **options: Any,
) -> BatchEnv:
    """Return `num_envs` copies of `ArmReach`; `gymnasium.make_vec` calls it."""
    return BatchEnv(
        num_envs,
        description,
        reach_task(tip, tolerance_m),
        actions=actions,
        max_episode_steps=max_episode_steps,
        **options,
    )
