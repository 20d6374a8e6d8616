"""The drives of all copies on a GPU as structures: what stays the same, and what changes."""

import warp as wp


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
    # How joints feel each other's motion, shape (layers, count * count); see `BrakingLaw`.
    entry: wp.array2d[wp.int32]
    weight: wp.array2d[wp.float64]
    # Shape (count * count,).
    related: wp.array[wp.int32]
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
class Streams:
    """The `CommandStreams` of all copies, arrays of shape (copies, joints)."""

    target: wp.array2d[wp.float64]
    velocity: wp.array2d[wp.float64]
    command: wp.array2d[wp.float64]
    left: wp.array2d[wp.int32]
    last_change: wp.array2d[wp.int32]


@wp.struct
class BrakingStates:
    """The bounds of all copies, arrays of shape (copies, joints) if not said otherwise."""

    part: wp.array2d[wp.float64]
    # Shape (copies,).
    way_to_renew: wp.array[wp.float64]
    # Of this period only.
    need: wp.array2d[wp.float64]
    room: wp.array2d[wp.float64]
    kept: wp.array2d[wp.float64]
    more: wp.array2d[wp.float64]
    share: wp.array2d[wp.float64]
    # Shape (copies, joints * joints).
    felt: wp.array2d[wp.float64]


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
