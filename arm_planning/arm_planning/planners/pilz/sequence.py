"""Sequences of motions, of which neighbours may be blended."""

import itertools
import logging
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from arm_planning.errors import InvalidPlanError, InvalidStateError, PlanningError
from arm_planning.planners.pilz.blend import DrivenMotion, Window, window
from arm_planning.planners.pilz.planner import Free, PilzPlanner
from arm_planning.planners.pilz.tip_motion import checked
from arm_planning.planners.problem import NO_DEADLINE, Deadline
from arm_planning.request import PlanRequest
from arm_planning.robot.model import JointGroup, JointPositions
from arm_planning.timing.slowed_motion import within_limits
from arm_planning.trajectory import TimedTrajectory

Array = NDArray[np.float64]

_log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class SequenceItem:
    """One motion of a sequence.

    Attributes:
        request: what to plan.
        blend_radius_m: how near the goal the next motion may begin; 0 to stop there.
    """

    request: PlanRequest
    blend_radius_m: float = 0.0


def plan_sequence(
    planner: PilzPlanner,
    items: Sequence[SequenceItem],
    state: JointPositions,
    free: Free | None = None,
    deadline: Deadline = NO_DEADLINE,
) -> tuple[TimedTrajectory, ...]:
    """Return the trajectories of a sequence, one for each run of motions of the same group.

    Each motion starts where the one of its group before it ended. Blended motions use a velocity
    and an acceleration limit that is the larger of both scalings, and slow down where that is not
    enough for the joints.

    Args:
        planner: plans the single motions.
        items: the motions; none gives no trajectory.
        state: positions of all joints at the start.
        free: as in `PilzPlanner.plan`.
        deadline: looked at before each motion.

    Raises:
        PlanningError: as in `PilzPlanner.plan`, the message begins with the number of the motion;
            INVALID_MOTION_PLAN: a blend radius is negative, the last is not 0, or two overlap;
            INVALID_ROBOT_STATE: a motion other than the first of its group has a start state.
    """
    _check_radii(items)
    _check_starts(items)
    radii = _usable_radii(planner, items)
    current = dict(state)
    motions: list[TimedTrajectory] = []
    for number, item in enumerate(items):
        deadline.check(f"planning motion {number} of the sequence")
        try:
            found = planner.plan(item.request, current, free)
        except PlanningError as error:
            raise PlanningError(error.code, f"motion {number} of the sequence: {error}") from error
        current.update(item.request.start or {})
        current.update(zip(found.joints, found.positions[-1].tolist(), strict=True))
        motions.append(found)
    _check_overlaps(planner, items, radii, motions, current)
    runs: list[tuple[int, int]] = []
    for number, item in enumerate(items):
        if number and items[number - 1].request.group == item.request.group:
            runs[-1] = (runs[-1][0], number + 1)
        else:
            runs.append((number, number + 1))
    return tuple(_run(planner, items[a:b], radii[a:b], motions[a:b], current, a) for a, b in runs)


def _check_radii(items: Sequence[SequenceItem]) -> None:
    for number, item in enumerate(items):
        if not 0.0 <= item.blend_radius_m < np.inf:
            raise InvalidPlanError(
                f"All blending radii MUST be non negative; that of motion {number} is "
                f"{item.blend_radius_m:g}"
            )
    if items and items[-1].blend_radius_m:
        raise InvalidPlanError(
            "The last blending radius must be zero; it is "
            f"{items[-1].blend_radius_m:g}, and no motion follows"
        )


def _check_starts(items: Sequence[SequenceItem]) -> None:
    seen: set[str] = set()
    for number, item in enumerate(items):
        if item.request.start and item.request.group in seen:
            raise InvalidStateError(
                f"Only the first request of group '{item.request.group}' may have a start state; "
                f"motion {number} has one, too"
            )
        seen.add(item.request.group)


def _usable_radii(planner: PilzPlanner, items: Sequence[SequenceItem]) -> list[float]:
    """Return the blend radii, 0 with a warning where Pilz does not blend."""
    radii = [item.blend_radius_m for item in items]
    for number, (item, following) in enumerate(itertools.pairwise(items)):
        if not radii[number]:
            continue
        group = item.request.group
        if group != following.request.group:
            why = f"groups '{group}' and '{following.request.group}' differ"
        elif not planner.model.group(group).tip:
            why = f"group '{group}' has no tip"
        else:
            continue
        radii[number] = 0.0
        _log.warning(
            "Invalid blend radii between commands: [%d] and [%d] => Blend radii set to zero: %s",
            number,
            number + 1,
            why,
        )
    return radii


def _check_overlaps(
    planner: PilzPlanner,
    items: Sequence[SequenceItem],
    radii: Sequence[float],
    motions: Sequence[TimedTrajectory],
    state: JointPositions,
) -> None:
    for number in range(len(items) - 1):
        if not radii[number] or items[number].request.group != items[number + 1].request.group:
            continue
        kinematics = planner.kinematics(items[number].request.group, "", state)
        here, there = (
            np.array(kinematics.tip_pose(motions[index].positions[-1]).position)
            for index in (number, number + 1)
        )
        distance = float(np.linalg.norm(there - here))
        if radii[number] + radii[number + 1] > distance:
            raise InvalidPlanError(
                f"Overlapping blend radii between command [{number}] and [{number + 1}].: "
                f"{radii[number]:g} m and {radii[number + 1]:g} m, {distance:.4f} m apart"
            )


def _run(
    planner: PilzPlanner,
    items: Sequence[SequenceItem],
    radii: Sequence[float],
    motions: Sequence[TimedTrajectory],
    state: JointPositions,
    offset: int,
) -> TimedTrajectory:
    """Return the motions of one group, one after another."""
    group = planner.model.group(items[0].request.group)
    parts: list[TimedTrajectory] = []
    first = 0
    for number in range(len(items)):
        if radii[number]:
            continue
        span = slice(first, number + 1)
        if number == first:
            parts.append(motions[number])
        else:
            parts.append(
                _blended(planner, items[span], radii[span], motions[span], state, offset + first)
            )
        first = number + 1
    return _appended(group, parts)


def _blended(
    planner: PilzPlanner,
    items: Sequence[SequenceItem],
    radii: Sequence[float],
    motions: Sequence[TimedTrajectory],
    state: JointPositions,
    offset: int,
) -> TimedTrajectory:
    group = planner.model.group(items[0].request.group)
    kinematics = planner.kinematics(group.name, "", state)
    functions = [DrivenMotion(trajectory) for trajectory in motions]
    windows = [
        window(a, b, radius, kinematics, f"blend of commands [{offset + i}] and [{offset + i + 1}]")
        for i, (a, b, radius) in enumerate(zip(functions, functions[1:], radii[:-1], strict=False))
    ]
    velocity = max(item.request.velocity_scaling for item in items)
    acceleration = max(item.request.acceleration_scaling for item in items)
    duration_s = sum(each.shift_s for each in windows) + functions[-1].duration_s
    states = partial(_states, functions, windows)
    found = within_limits(states, duration_s, group, velocity, acceleration)
    return checked("sequence", found, group.limits, velocity, acceleration)


def _states(functions: Sequence[DrivenMotion], windows: Sequence[Window], times_s: Array) -> Array:
    """Return joint positions at times since the start of the first motion, (k, n)."""
    states = functions[0].positions(times_s)
    start = 0.0
    for each in windows:
        inside = (times_s >= start + each.begin_s) & (times_s < start + each.end_s)
        after = times_s >= start + each.end_s
        states[inside] = each.positions(times_s[inside] - start)
        start += each.shift_s
        states[after] = each.second.positions(times_s[after] - start)
    return states


def _appended(group: JointGroup, parts: Sequence[TimedTrajectory]) -> TimedTrajectory:
    """Return trajectories that rest at their ends, one after another."""
    whole = parts[0]
    for part in parts[1:]:
        times = np.round(np.concatenate((whole.times_s, whole.duration_s + part.times_s[1:])), 9)
        whole = replace(
            whole,
            joints=group.joints,
            times_s=times,
            positions=np.concatenate((whole.positions, part.positions[1:])),
            velocities=np.concatenate((whole.velocities, part.velocities[1:])),
            accelerations=np.concatenate((whole.accelerations, part.accelerations[1:])),
        )
    return whole
