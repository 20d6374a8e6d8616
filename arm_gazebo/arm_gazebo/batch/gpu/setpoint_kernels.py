"""The set-points of joints on a GPU: what `setpoint_batch` does, for one joint of one copy.

The same operations in the same order, in 64 bits and without fused multiplications, so that every
number has the same bits as on the host.
"""

import warp as wp

from arm_gazebo.batch.gpu.drive_states import Streams
from arm_gazebo.drives.driven_joint import LANDING_SPEED, MAX_INTERVAL_S
from arm_gazebo.drives.setpoint import LANDING_SLACK, LATE_BRAKING

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

ZERO, ONE = wp.constant(wp.float64(0.0)), wp.constant(wp.float64(1.0))
QUARTER, HALF, TWO = (wp.constant(wp.float64(value)) for value in (0.25, 0.5, 2.0))
LONGEST_S = wp.constant(wp.float64(MAX_INTERVAL_S))
SLACK = wp.constant(wp.float64(LANDING_SLACK))
LATE = wp.constant(wp.float64(LATE_BRAKING))
SLOWEST = wp.constant(wp.float64(LANDING_SPEED))


@wp.func
def take(
    streams: Streams,
    copy: wp.int32,
    joint: wp.int32,
    command: wp.float64,
    tick: wp.int32,
    period_s: wp.float64,
) -> None:
    """Take the command of a control period; see `CommandStream.command`."""
    if command != streams.command[copy, joint]:
        interval = tick - streams.last_change[copy, joint]
        streams.command[copy, joint] = command
        streams.last_change[copy, joint] = tick
        if wp.float64(interval) * period_s > LONGEST_S:
            streams.left[copy, joint] = 0
            streams.target[copy, joint] = command
            streams.velocity[copy, joint] = ZERO
        else:
            left = wp.max(interval, 1)
            streams.left[copy, joint] = left
            streams.velocity[copy, joint] = (command - streams.target[copy, joint]) / (
                wp.float64(left) * period_s
            )


@wp.func
def advance(streams: Streams, copy: wp.int32, joint: wp.int32, period_s: wp.float64) -> None:
    """Advance a target by one control period; see `CommandStream.advance`."""
    left = streams.left[copy, joint]
    if left > 1:
        streams.left[copy, joint] = left - 1
        moved = streams.velocity[copy, joint] * period_s
        streams.target[copy, joint] = streams.target[copy, joint] + moved
    elif left == 1:
        streams.left[copy, joint] = 0
        streams.target[copy, joint] = streams.command[copy, joint]
    else:
        streams.velocity[copy, joint] = ZERO


@wp.func
def held_back(
    position: wp.float64,
    velocity: wp.float64,
    joint_position: wp.float64,
    joint_velocity: wp.float64,
    slack: wp.float64,
) -> tuple[wp.float64, wp.float64]:
    """Return a set-point that does not run ahead of its joint; see `DrivenJoint.plan`."""
    lead = position - joint_position
    held, slow = position, velocity
    if lead > slack:
        held = joint_position + slack
        slow = wp.min(velocity, wp.max(joint_velocity, ZERO))
    elif lead < -slack:
        held = joint_position - slack
        slow = wp.max(velocity, wp.min(joint_velocity, ZERO))
    return held, slow


@wp.func
def proportional_speed(
    distance: wp.float64,
    velocity: wp.float64,
    speed: wp.float64,
    rate_per_s: wp.float64,
    period_s: wp.float64,
) -> wp.float64:
    """Return the speed of an exponential approach; see `DrivenJoint`."""
    half_s = HALF * period_s
    left = wp.abs(distance) - half_s * wp.abs(velocity)
    wanted = rate_per_s * left / (ONE + rate_per_s * half_s)
    return wp.where(wanted > SLOWEST, wp.min(wanted, speed), speed)


@wp.func
def approach(
    position: wp.float64,
    start_velocity: wp.float64,
    target: wp.float64,
    target_velocity: wp.float64,
    speed: wp.float64,
    acceleration: wp.float64,
    braking: wp.float64,
    period_s: wp.float64,
) -> tuple[wp.float64, wp.float64]:
    """Return position and velocity after a control period; see `Setpoint.approach`."""
    followed = wp.min(wp.max(target_velocity, -speed), speed)
    gap = target - position
    distance = target - followed * period_s - position
    velocity = start_velocity - followed
    change, brake = acceleration * period_s, braking * period_s
    landing = wp.where(followed != ZERO, change, brake)
    reach = speed * period_s * SLACK
    miss = distance - HALF * velocity * period_s
    near = wp.abs(velocity) <= landing and wp.abs(gap) <= reach
    end_position, end_velocity = target, followed
    if not (near and wp.abs(miss) <= QUARTER * landing * period_s):
        sign = wp.float64(1.0)
        if distance < ZERO or (distance == ZERO and velocity > ZERO):
            sign = wp.float64(-1.0)
        distance = distance * sign
        velocity = velocity * sign
        root = brake * (QUARTER * brake - velocity) + TWO * braking * distance
        cruise = speed - sign * followed
        fastest = wp.float64(-wp.inf)
        if root > ZERO:
            fastest = wp.sqrt(root) - HALF * brake
        hardest = wp.max(LATE * brake, change)
        if fastest > cruise:
            fastest = cruise
            hardest = change
        fastest = wp.max(wp.min(fastest, velocity + change), velocity - hardest)
        end_velocity = followed + sign * fastest
        end_position = position + HALF * period_s * (start_velocity + end_velocity)
    return end_position, end_velocity
