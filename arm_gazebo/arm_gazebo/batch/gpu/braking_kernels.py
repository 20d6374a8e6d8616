"""The bounds on braking on a GPU: what `BrakingLaw.parts_of_many` does, for one copy.

The same operations in the same order, in 64 bits and without fused multiplications, so that every
number has the same bits as on the host.
"""

import warp as wp

from arm_gazebo.batch.gpu.drive_states import BrakingStates, DriveLaw
from arm_gazebo.batch.gpu.setpoint_kernels import HALF, ONE, ZERO
from arm_gazebo.drives import braking_law
from arm_gazebo.drives.driven_joint import NEAREST
from arm_gazebo.drives.servo_tuning import EFFORT_SHARE
from arm_gazebo.robot.actuation import UNLIMITED

wp.set_module_options({"enable_backward": False, "fuse_fp": False})

PLANNED = wp.constant(wp.float64(EFFORT_SHARE))
FLOOR = wp.constant(wp.float64(braking_law.FLOOR))
LARGEST = wp.constant(wp.float64(braking_law.LARGEST))
RESTING = wp.constant(wp.float64(braking_law.RESTING))
LEAST_LEFT = wp.constant(wp.float64(braking_law.LEAST_LEFT))
TINY = wp.constant(wp.float64(braking_law.TINY))
STRONGEST = wp.constant(wp.float64(UNLIMITED))
CLOSE = wp.constant(wp.float64(NEAREST))
RESTS = wp.constant(wp.float64(-1.0))


@wp.func
def budget(effort: wp.float64, gravity: wp.float64) -> wp.float64:
    """Return the effort that a joint may need for all motions; see `braking_law.budget`."""
    most = wp.min(effort, STRONGEST)
    return PLANNED * wp.max(most - wp.abs(gravity), LEAST_LEFT * most)


@wp.func
def needed_braking(gap: wp.float64, velocity: wp.float64) -> wp.float64:
    """Return the deceleration that stops a motion; see `DrivenJoint.needed_braking`."""
    return HALF * velocity * velocity / wp.max(wp.abs(gap), CLOSE)


@wp.func
def renew_parts(
    joints: DriveLaw, bounds: BrakingStates, copy: wp.int32, inertia: wp.array2d[wp.float32]
) -> None:
    """Renew the parts of the joints that move, from their needs and rooms."""
    count = joints.count
    for first in range(count):
        most = wp.float64(0.0)
        for second in range(count):
            cell = first * count + second
            felt = wp.float64(0.0)
            for layer in range(joints.entry.shape[0]):
                value = wp.abs(wp.float64(inertia[copy, joints.entry[layer, cell]]))
                felt += value * joints.weight[layer, cell]
            if first == second:
                felt += joints.followers_inertia[first]
            felt = felt * bounds.room[copy, second]
            bounds.felt[copy, cell] = felt
            most = wp.max(most, felt)
        most = wp.max(most, TINY)
        bounds.kept[copy, first] = ZERO
        bounds.more[copy, first] = ZERO
        if bounds.need[copy, first] >= ZERO:
            alone = wp.min(ONE / most, joints.jerkless[first])
            kept = wp.min(bounds.need[copy, first], LARGEST / most)
            kept = wp.max(kept, FLOOR * joints.sure[first])
            bounds.kept[copy, first] = kept
            if alone > kept:
                bounds.more[copy, first] = alone - kept
    for second in range(count):
        taken, asked = wp.float64(0.0), wp.float64(0.0)
        for first in range(count):
            felt = bounds.felt[copy, first * count + second]
            taken += felt * bounds.kept[copy, first]
            asked += felt * bounds.more[copy, first]
        share = wp.float64(1.0)
        if taken + asked > ONE:
            share = wp.float64(0.0)
            if taken < ONE:
                share = (ONE - taken) / asked
        bounds.share[copy, second] = share
    for first in range(count):
        if bounds.need[copy, first] >= ZERO:
            least = wp.float64(1.0)
            for second in range(count):
                if joints.related[first * count + second] == 1:
                    least = wp.min(least, bounds.share[copy, second])
            braking = bounds.kept[copy, first] + bounds.more[copy, first] * least
            bounds.part[copy, first] = bounds.felt[copy, first * count + first] * braking
