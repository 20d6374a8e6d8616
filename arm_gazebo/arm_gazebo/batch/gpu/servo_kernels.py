"""The law of the drives as kernels for a GPU: what `ServoBatch` does, a thread for a copy.

In 64 bits and without fused multiplications, so that every number has the same bits as on the host.
"""

import warp as wp

from arm_gazebo.batch.gpu.braking_kernels import (
    FLOOR,
    RESTING,
    RESTS,
    budget,
    needed_braking,
    renew_parts,
)
from arm_gazebo.batch.gpu.drive_states import DriveLaw, DriveStates
from arm_gazebo.batch.gpu.setpoint_kernels import (
    HALF,
    ONE,
    ZERO,
    advance,
    approach,
    held_back,
    proportional_speed,
    take,
)
from arm_gazebo.drives.braking_law import RENEW_EVERY
from arm_gazebo.drives.driven_joint import DriveMode
from arm_gazebo.drives.servo import MODE_NUMBERS, USABLE_EFFORT, WAKE_DISTANCE
from arm_gazebo.drives.setpoint_batch import LONG_AGO

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

POSITION, VELOCITY, EFFORT = (
    wp.constant(MODE_NUMBERS[mode])
    for mode in (DriveMode.POSITION, DriveMode.VELOCITY, DriveMode.EFFORT)
)
USABLE = wp.constant(wp.float64(USABLE_EFFORT))
RENEWS = wp.constant(wp.float64(RENEW_EVERY))
WAKES = wp.constant(wp.float64(WAKE_DISTANCE))


@wp.kernel
def restart(
    joints: DriveLaw,
    drives: DriveStates,
    start: wp.array[wp.float64],
    rows: wp.array[wp.int32],
) -> None:
    """Restart the drives of some copies at rest; see `ServoBatch.restart`."""
    copy = rows[wp.tid()]
    drives.tick[copy] = 0
    drives.awake[copy] = joints.settle_ticks
    drives.bounds.way_to_renew[copy] = ZERO
    for joint in range(joints.count):
        drives.bounds.part[copy, joint] = ZERO
        position = start[joints.address[joint]]
        stop = wp.min(wp.max(position, joints.lower[joint]), joints.upper[joint])
        drives.position[copy, joint] = position
        drives.velocity[copy, joint] = ZERO
        drives.start_position[copy, joint] = position
        drives.start_velocity[copy, joint] = ZERO
        drives.taken[copy, joint] = wp.float64(wp.nan)
        drives.streams.target[copy, joint] = stop
        drives.streams.velocity[copy, joint] = ZERO
        drives.streams.command[copy, joint] = stop
        drives.streams.left[copy, joint] = 0
        drives.streams.last_change[copy, joint] = wp.static(LONG_AGO)


@wp.kernel
def command(joints: DriveLaw, drives: DriveStates, values: wp.array2d[wp.float64]) -> None:
    """Take commands; see `ServoBatch.command`."""
    copy = wp.tid()
    new = wp.int32(0)
    for joint in range(joints.count):
        # The bytes are compared, as in `Servo`.
        if wp.cast(values[copy, joint], wp.int64) != wp.cast(drives.taken[copy, joint], wp.int64):
            new = 1
    if new == 1:
        drives.awake[copy] = joints.settle_ticks
        for joint in range(joints.count):
            value = values[copy, joint]
            if drives.velocity[copy, joint] == ZERO and differs(joints, drives, copy, joint, value):
                drives.bounds.way_to_renew[copy] = ZERO
            drives.taken[copy, joint] = value
            if joints.mode[joint] == POSITION:
                take(drives.streams, copy, joint, value, drives.tick[copy], joints.period_s)


@wp.kernel
def update(
    joints: DriveLaw,
    drives: DriveStates,
    qpos: wp.array2d[wp.float32],
    qvel: wp.array2d[wp.float32],
    inertia: wp.array2d[wp.float32],
    bias: wp.array2d[wp.float32],
    act: wp.array2d[wp.float32],
    ctrl: wp.array2d[wp.float32],
) -> None:
    """Drive the joints for one control period; see `ServoBatch.update`."""
    copy = wp.tid()
    tick = drives.tick[copy] + 1
    drives.tick[copy] = tick
    if drives.awake[copy] == 0:
        if tick % joints.check_ticks != 0 or not moved(joints, drives, copy, qpos):
            return
        drives.awake[copy] = joints.settle_ticks
    for joint in range(joints.count):
        drives.gravity[copy, joint] = wp.float64(bias[copy, joints.dof[joint]])
    for each in range(joints.follower_joint.shape[0]):
        joint = joints.follower_joint[each]
        felt = joints.follower_ratio[each] * wp.float64(bias[copy, joints.follower_dof[each]])
        drives.gravity[copy, joint] = drives.gravity[copy, joint] + felt
    if drives.bounds.way_to_renew[copy] <= ZERO:
        renew_braking(joints, drives, copy, inertia)
    stays = wp.int32(0)
    farthest = wp.float64(0.0)
    for joint in range(joints.count):
        if joints.servoed[joint] == 0:
            advance(drives.streams, copy, joint, joints.period_s)
            stays = 1
        elif plan(joints, drives, copy, joint, qpos, qvel, inertia):
            way = drives.position[copy, joint] - drives.start_position[copy, joint]
            farthest = wp.max(farthest, wp.abs(way))
            stays = 1
    drives.bounds.way_to_renew[copy] = drives.bounds.way_to_renew[copy] - farthest
    plan_efforts(joints, drives, copy, inertia, bias)
    if slow_down(joints, drives, copy):
        plan_efforts(joints, drives, copy, inertia, bias)
    for joint in range(joints.count):
        write(joints, drives, copy, joint, act, ctrl)
    awake = wp.where(stays == 1, joints.settle_ticks, drives.awake[copy] - 1)
    drives.awake[copy] = awake
    if awake == 0:
        for joint in range(joints.count):
            drives.still[copy, joint] = wp.float64(qpos[copy, joints.address[joint]])


@wp.func
def moved(
    joints: DriveLaw, drives: DriveStates, copy: wp.int32, qpos: wp.array2d[wp.float32]
) -> wp.bool:
    """Return whether something moved the joints of a copy whose drives sleep."""
    squares = wp.float64(0.0)
    for joint in range(joints.count):
        gap = wp.float64(qpos[copy, joints.address[joint]]) - drives.still[copy, joint]
        squares += gap * gap
    return squares > WAKES * WAKES


@wp.func
def last_command(drives: DriveStates, copy: wp.int32, joint: wp.int32) -> wp.float64:
    """Return a joint's last command, 0 for none."""
    asked = drives.taken[copy, joint]
    return wp.where(wp.isnan(asked), wp.float64(0.0), asked)


@wp.func
def differs(
    joints: DriveLaw, drives: DriveStates, copy: wp.int32, joint: wp.int32, value: wp.float64
) -> wp.bool:
    """Return whether a command may move a resting set-point; see `DrivenJoint.command`."""
    if joints.mode[joint] == POSITION:
        return value != drives.streams.command[copy, joint]
    return joints.mode[joint] == VELOCITY and value != last_command(drives, copy, joint)


@wp.func
def renew_braking(
    joints: DriveLaw, drives: DriveStates, copy: wp.int32, inertia: wp.array2d[wp.float32]
) -> None:
    """Bound the braking of the joints that move by the present pose; see `Servo`."""
    bounds = drives.bounds
    bounds.way_to_renew[copy] = RENEWS
    for joint in range(joints.count):
        position, velocity = drives.position[copy, joint], drives.velocity[copy, joint]
        target = drives.streams.target[copy, joint]
        rests = drives.streams.velocity[copy, joint] != ZERO or (
            velocity == ZERO and target == position
        )
        if joints.mode[joint] == VELOCITY:
            asked = last_command(drives, copy, joint)
            rests = velocity == ZERO and asked == ZERO
            target = wp.where(asked > ZERO, joints.upper[joint], joints.lower[joint])
        bounds.need[copy, joint] = needed_braking(target - position, velocity)
        bounds.room[copy, joint] = ONE / budget(joints.effort[joint], drives.gravity[copy, joint])
        if joints.servoed[joint] == 0:
            rests = True
            bounds.room[copy, joint] = ZERO
        if rests:
            bounds.need[copy, joint] = RESTS
            if velocity == ZERO:
                bounds.room[copy, joint] = bounds.room[copy, joint] * RESTING
    renew_parts(joints, bounds, copy, inertia)


@wp.func
def plan(
    joints: DriveLaw,
    drives: DriveStates,
    copy: wp.int32,
    joint: wp.int32,
    qpos: wp.array2d[wp.float32],
    qvel: wp.array2d[wp.float32],
    inertia: wp.array2d[wp.float32],
) -> wp.bool:
    """Advance the set-point of a joint that has one; return whether it moves."""
    advance(drives.streams, copy, joint, joints.period_s)
    position, velocity = held_back(
        drives.position[copy, joint],
        drives.velocity[copy, joint],
        wp.float64(qpos[copy, joints.address[joint]]),
        wp.float64(qvel[copy, joints.dof[joint]]),
        joints.slack[joint],
    )
    target = drives.streams.target[copy, joint]
    speed = joints.speed[joint]
    target_velocity = drives.streams.velocity[copy, joint]
    rests = target == position and target_velocity == ZERO and velocity == ZERO
    if joints.mode[joint] == VELOCITY:
        asked = last_command(drives, copy, joint)
        rests = False
        speed = wp.abs(asked)
        target = wp.where(asked > ZERO, joints.upper[joint], joints.lower[joint])
        target_velocity = wp.float64(0.0)
    elif joints.mode[joint] == POSITION and joints.rate_per_s != ZERO:
        target_velocity = wp.float64(0.0)
        speed = proportional_speed(
            target - position, velocity, speed, joints.rate_per_s, joints.period_s
        )
    felt = wp.float64(inertia[copy, joints.diagonal[joint]]) + joints.followers_inertia[joint]
    acceleration = budget(joints.effort[joint], drives.gravity[copy, joint]) / felt
    braking = wp.min(drives.bounds.part[copy, joint] * acceleration, joints.jerkless[joint])
    braking = wp.max(braking, FLOOR * joints.sure[joint])
    acceleration = wp.max(wp.min(acceleration, joints.jerkless[joint]), joints.sure[joint])
    end, end_velocity = approach(
        position,
        velocity,
        target,
        target_velocity,
        speed,
        acceleration,
        braking,
        joints.period_s,
    )
    if rests:
        end = position
        end_velocity = velocity
    drives.start_position[copy, joint] = position
    drives.start_velocity[copy, joint] = velocity
    drives.position[copy, joint] = end
    drives.velocity[copy, joint] = end_velocity
    return not rests and (end_velocity != ZERO or end != position)


@wp.func
def plan_efforts(
    joints: DriveLaw,
    drives: DriveStates,
    copy: wp.int32,
    inertia: wp.array2d[wp.float32],
    bias: wp.array2d[wp.float32],
) -> None:
    """Store inertia x acceleration + gravity and Coriolis effort of the joints."""
    for dof in range(drives.load.shape[1]):
        drives.load[copy, dof] = ZERO
    for term in range(joints.term_row.shape[0]):
        joint = joints.term_joint[term]
        row = joints.term_row[term]
        if joints.servoed[joint] == 1:
            gain = drives.velocity[copy, joint] - drives.start_velocity[copy, joint]
            motion = gain * joints.term_factor[term]
            part = wp.float64(inertia[copy, joints.term_entry[term]]) * motion
            drives.load[copy, row] = drives.load[copy, row] + part
    for joint in range(joints.count):
        dof = joints.dof[joint]
        drives.planned[copy, joint] = drives.load[copy, dof] + wp.float64(bias[copy, dof])
    for each in range(joints.follower_joint.shape[0]):
        joint = joints.follower_joint[each]
        dof = joints.follower_dof[each]
        felt = drives.load[copy, dof] + wp.float64(bias[copy, dof])
        felt = joints.follower_ratio[each] * felt
        drives.planned[copy, joint] = drives.planned[copy, joint] + felt


@wp.func
def slow_down(joints: DriveLaw, drives: DriveStates, copy: wp.int32) -> wp.bool:
    """Slow a planned motion that needs too much effort; return whether it does."""
    over = wp.int32(0)
    share = wp.float64(1.0)
    for joint in range(joints.count):
        effort = drives.planned[copy, joint]
        gravity = drives.gravity[copy, joint]
        limit = USABLE * joints.effort[joint]
        if joints.servoed[joint] == 1 and wp.abs(effort) > limit:
            over = 1
            moving = effort - gravity
            room = limit - wp.where(gravity * moving < ZERO, -wp.abs(gravity), wp.abs(gravity))
            if room > ZERO and room < wp.abs(moving):
                share = wp.min(share, room / wp.abs(moving))
    if over == 1:
        for joint in range(joints.count):
            start = drives.start_velocity[copy, joint]
            velocity = drives.velocity[copy, joint]
            gain = velocity - start
            if joints.servoed[joint] == 1 and gain * velocity > ZERO:
                velocity = start + share * gain
                mean = HALF * (start + velocity)
                drives.velocity[copy, joint] = velocity
                begin = drives.start_position[copy, joint]
                drives.position[copy, joint] = begin + mean * joints.period_s
    return over == 1


@wp.func
def write(
    joints: DriveLaw,
    drives: DriveStates,
    copy: wp.int32,
    joint: wp.int32,
    act: wp.array2d[wp.float32],
    ctrl: wp.array2d[wp.float32],
) -> None:
    """Write the activation of a joint's actuator at the start of the period, and its rate."""
    activation, rate = wp.float64(0.0), wp.float64(0.0)
    if joints.servoed[joint] == 1:
        speed = drives.velocity[copy, joint]
        start_speed = drives.start_velocity[copy, joint]
        effort = drives.planned[copy, joint]
        if speed != ZERO:
            friction = joints.friction[joint]
            effort += joints.drag[joint] * speed + wp.where(speed < ZERO, -friction, friction)
        effort = wp.max(wp.min(effort, joints.effort[joint]), -joints.effort[joint])
        start = drives.start_position[copy, joint]
        lead_s = joints.lead_s
        activation = start + lead_s * start_speed + effort * joints.compliance[joint]
        end = drives.position[copy, joint]
        rate = (end - start + lead_s * (speed - start_speed)) * joints.per_period
    elif joints.mode[joint] == EFFORT and not wp.isnan(drives.taken[copy, joint]):
        activation = drives.taken[copy, joint]
    act[copy, joints.activation[joint]] = wp.float32(activation)
    ctrl[copy, joints.control[joint]] = wp.float32(rate)
