"""The drives of all copies on a GPU as structures: what stays the same, and what changes."""

import warp as wp

from arm_gazebo.batch.gpu.braking_kernels import BrakingStates, CoupledJoints
from arm_gazebo.batch.gpu.setpoint_kernels import Streams


@wp.struct
class DriveLaw:
    """What stays the same: the joints, arrays of shape (joints,) if not said otherwise."""

    count: wp.int32
    mode: wp.array[wp.int32]
    servoed: wp.array[wp.int32]
    address: wp.array[wp.int32]
    dof: wp.array[wp.int32]
    control: wp.array[wp.int32]
    activation: wp.array[wp.int32]
    diagonal: wp.array[wp.int32]
    effort: wp.array[wp.float64]
    speed: wp.array[wp.float64]
    lower: wp.array[wp.float64]
    upper: wp.array[wp.float64]
    sure: wp.array[wp.float64]
    jerkless: wp.array[wp.float64]
    slack: wp.array[wp.float64]
    friction: wp.array[wp.float64]
    drag: wp.array[wp.float64]
    compliance: wp.array[wp.float64]
    followers_inertia: wp.array[wp.float64]
    coupled: CoupledJoints
    # Mimic joints, shape (followers,).
    follower_joint: wp.array[wp.int32]
    follower_dof: wp.array[wp.int32]
    follower_ratio: wp.array[wp.float64]
    # Terms of the product with the inertia matrix, shape (terms,).
    term_row: wp.array[wp.int32]
    term_entry: wp.array[wp.int32]
    term_joint: wp.array[wp.int32]
    term_factor: wp.array[wp.float64]
    period_s: wp.float64
    per_period: wp.float64
    rate_per_s: wp.float64
    lead_s: wp.float64
    settle_ticks: wp.int32
    check_ticks: wp.int32


@wp.struct
class DriveStates:
    """The state of the drives: shape (copies, joints) if not said otherwise."""

    # Shape (copies,).
    tick: wp.array[wp.int32]
    awake: wp.array[wp.int32]
    still: wp.array2d[wp.float64]
    position: wp.array2d[wp.float64]
    velocity: wp.array2d[wp.float64]
    taken: wp.array2d[wp.float64]
    streams: Streams
    bounds: BrakingStates
    # Of this period only.
    start_position: wp.array2d[wp.float64]
    start_velocity: wp.array2d[wp.float64]
    gravity: wp.array2d[wp.float64]
    planned: wp.array2d[wp.float64]
    # Shape (copies, nv).
    load: wp.array2d[wp.float64]
