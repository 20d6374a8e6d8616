"""The task of lifting the cylinder that stands in front of the myCobot, and its expert.

The expert's picks are planned around what is in the world, then straight to the object and up. It
grips from the side, with the arm bent forwards. For an object at a distance there is a narrow range
of headings in which the arm touches neither itself nor anything else.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from arm_controller.pick_plan import (
    APPROACH_M,
    CLOSED,
    HAND,
    JOINTS,
    STRAIGHT_S,
    WIDE_OPEN,
    JointPath,
    PlanError,
    hand_at,
    reversed_path,
    straight_path,
)
from arm_description.urdf.parser import parse_urdf
from arm_planning.errors import PlanningError
from arm_planning.kinematics.inverse import InverseKinematics
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

WORLD = "pick"
"""The world of the launch without what the arm does not reach."""
OBJECT = "red_cylinder"
FINGERS = ("gripper_left1", "gripper_right1")
STANDING_M = 0.175
"""Height of the cylinder's middle while it stands on the floor."""
LOWEST_LIFT_M, HIGHEST_LIFT_M = 0.04, 0.08
REWARD_PER_M = 20.0
"""Reward for each metre of height, besides 1 for each metre closer to the cylinder."""


def pick_task() -> Task:
    """Return the task of gripping the cylinder and lifting it to a height.

    Observations are the joints' positions and velocities, the cylinder's middle `object`, the
    vector `reach` to it from the midpoint of the fingers, and the height `rise` by which it must
    still be lifted, in rad, m and s. The reward is minus the length of that vector, and 20 for each
    metre that the cylinder is above its place, up to the height. An episode ends when it is that
    high.
    """

    def reach(scene: Scene) -> Array:
        left, right = (scene.point(finger) for finger in FINGERS)
        return scene.point(OBJECT) - 0.5 * (left + right)

    def lifted(scene: Scene) -> Array:
        return scene.point(OBJECT)[..., 2] - STANDING_M

    def reward(scene: Scene) -> Array:
        distance = np.sqrt(np.add.reduce(reach(scene) ** 2, axis=-1))
        # Not np.clip, which takes many times as long, as does the method `sum` above.
        height = np.minimum(np.maximum(lifted(scene), 0.0), scene.goal["lift"][..., 0])
        return REWARD_PER_M * height - distance

    def done(scene: Scene) -> Flags:
        return lifted(scene) >= scene.goal["lift"][..., 0]

    return Task(
        observations={
            "position": JOINT_POSITIONS,
            "velocity": JOINT_VELOCITIES,
            "object": Observation(lambda scene: scene.point(OBJECT), -10.0, 10.0),
            "reach": Observation(reach, -10.0, 10.0),
            "rise": Observation(
                lambda scene: scene.goal["lift"] - lifted(scene)[..., None], -10.0, 10.0
            ),
        },
        reward=reward,
        terminated=done,
        succeeded=done,
        start=lambda scene, random: {"lift": random.uniform(LOWEST_LIFT_M, HIGHEST_LIFT_M, 1)},
    )


class ArmPick(ArmEnv):
    """Grip the cylinder with the myCobot and lift it; the seventh joint is the gripper.

    Args:
        actions: see `ArmEnv`.
        expert: whether infos contain the action of a planned pick as `expert_action`.
        options: further arguments of `ArmEnv`.
    """

    def __init__(self, actions: str = "step", expert: bool = False, **options: Any) -> None:
        if expert:
            options["expert"] = pick_expert
        super().__init__("mycobot", pick_task(), actions=actions, **_in_world(options))


def pick_batch(
    num_envs: int, max_episode_steps: int, actions: str = "step", **options: Any
) -> BatchEnv:
    """Return `num_envs` copies of `ArmPick`; `gymnasium.make_vec` calls it."""
    return BatchEnv(
        num_envs,
        "mycobot",
        pick_task(),
        actions=actions,
        max_episode_steps=max_episode_steps,
        **_in_world(options),
    )


def _in_world(options: Mapping[str, Any]) -> dict[str, Any]:
    """Return options with the world of the pick, unless they name another."""
    return {**options, "simulation": {"world": WORLD, **(options.get("simulation") or {})}}


ROOT, GROUP, GRIPPER = "base_link", "arm", "gripper_controller"
GRIP_M = 0.205
"""Height of the grip above the floor: above the object's middle, so that it hangs upright."""
SPARE_LIFT_M = 0.015
"""What the object is lifted beyond its goal, because it lags and slips a little."""
POSTURE = (0.63, 1.15, 1.08, -2.28, -1.4, 0.05)
"""Start of the inverse kinematics; the first joint is relative to the object's direction."""
HEADINGS_DEG = np.arange(68.0, 40.0, -1.5)
"""Directions of the fingers relative to the object's direction; near objects need the first."""
IK_TIMEOUT_S = 0.005
SWING_S, CLOSE_S = 2.4, 1.2
PLANNING_S = 60.0
"""Far more than any plan takes: a busy machine must not decide whether there is one."""


@dataclass(frozen=True, slots=True)
class _Grasp:
    """The straight parts of a pick.

    Attributes:
        before: positions of the arm's joints where the approach starts, shape (6,).
        approach: the way from there to the grasp.
        up: the way up from the grasp.
    """

    before: Sequence[float]
    approach: JointPath
    up: JointPath


def pick_expert(env: ArmEnv) -> WayExpert:
    """Return an expert that grips the cylinder where it stands, and lifts it to the goal.

    Args:
        env: an environment of the myCobot, all joints of which are commanded, at the start of an
            episode.

    Raises:
        PlanError: the cylinder cannot be gripped there.
        PlanningError: there is no way to it; the message says why.
        CallError: the environment does not command all joints.
    """
    missing = {*JOINTS, GRIPPER} - {*env.joints}
    if missing:
        raise CallError(f"the expert needs all joints; {', '.join(sorted(missing))} is left out")
    sim = env.simulation
    place = sim.pose(OBJECT, ROOT)[:3, 3] + [0.0, 0.0, GRIP_M - env.point(OBJECT)[2]]
    check = sim.collision_check([*JOINTS, GRIPPER], [OBJECT])
    grasp = _find_grasp(
        InverseKinematics.for_link(parse_urdf(sim.parts.robot.document), HAND, JOINTS),
        place,
        float(env.goal["lift"][0]) + SPARE_LIFT_M,
        lambda q: check(np.append(q, WIDE_OPEN)),
    )
    return WayExpert(_way(env, grasp))


def _find_grasp(
    kinematics: InverseKinematics, place: Array, lift_m: float, is_free: Callable[[Array], bool]
) -> _Grasp:
    """Return a grasp whose straight ways are free.

    Args:
        kinematics: the inverse kinematics of the hand.
        place: between the pads, in the root's frame, shape (3,).
        lift_m: how far up it goes.
        is_free: tells of positions of the arm, shape (6,), with the gripper open.

    Raises:
        PlanError: there is none.
    """
    direction = math.atan2(place[1], place[0])
    posture = np.array([direction, 0.0, 0.0, 0.0, 0.0, 0.0]) + POSTURE
    for heading in direction + np.radians(HEADINGS_DEG):
        ahead = np.array([math.cos(heading), math.sin(heading), 0.0])
        try:
            there = kinematics.solve(hand_at(place, ahead), posture, timeout_s=IK_TIMEOUT_S)
            if not is_free(there):
                continue
            q = tuple(there.tolist())
            before = hand_at(place - APPROACH_M * ahead, ahead)
            away = straight_path(kinematics, q, before, STRAIGHT_S)
            above = hand_at(place + np.array([0.0, 0.0, lift_m]), ahead)
            up = straight_path(kinematics, q, above, STRAIGHT_S)
        except (PlanningError, PlanError):
            continue
        if all(is_free(np.array(point.positions)) for point in (*away, *up)):
            return _Grasp(away[-1].positions, reversed_path(away, q), up)
    raise PlanError(
        f"the arm cannot grip at ({', '.join(f'{one:.3f}' for one in place)}) m without touching "
        "itself or something else"
    )


def _way(env: ArmEnv, grasp: _Grasp) -> Array:
    """Return the commands of a pick, one for each action, shape (m, n)."""
    names = (*JOINTS, GRIPPER)
    start = env.command[[env.joints.index(name) for name in names]]
    swing = env.simulation.plan(
        dict(zip(JOINTS, grasp.before, strict=True)), GROUP, allowed_time_s=PLANNING_S
    )
    columns = [swing.joints.index(name) for name in JOINTS]
    times_s, positions = np.asarray(swing.times_s), np.asarray(swing.positions)[:, columns]
    slowed = times_s * max(1.0, SWING_S / times_s[-1])
    closing = round(CLOSE_S / env.decision_s)
    arm = [
        _at_actions(env, slowed, positions),
        _along(env, grasp.before, grasp.approach),
        np.tile(grasp.approach[-1].positions, (closing, 1)),
        _along(env, grasp.approach[-1].positions, grasp.up),
    ]
    fingers = [
        np.linspace(start[-1], WIDE_OPEN, len(arm[0])),
        np.full(len(arm[1]), WIDE_OPEN),
        np.linspace(WIDE_OPEN, CLOSED, closing),
        np.full(len(arm[3]), CLOSED),
    ]
    way = np.column_stack([np.concatenate(arm), np.concatenate(fingers)])
    return way[:, [names.index(name) for name in env.joints]]


def _along(env: ArmEnv, start: Sequence[float], path: JointPath) -> Array:
    times_s = np.array([0.0, *(point.time_s for point in path)])
    return _at_actions(env, times_s, np.array([start, *(point.positions for point in path)]))


def _at_actions(env: ArmEnv, times_s: Array, positions: Array) -> Array:
    """Return positions at the times of actions, shape (m, n)."""
    count = max(1, round(times_s[-1] / env.decision_s))
    wanted = np.linspace(0.0, times_s[-1], count + 1)
    return np.column_stack([np.interp(wanted, times_s, joint) for joint in positions.T])
