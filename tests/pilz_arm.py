"""An arm of six joints, and requests for it, for tests of PTP, LIN and CIRC."""

import numpy as np
from planning_models import model_of
from robots import joint, link, robot

from arm_node.rigid_transform import RigidTransform
from arm_planning.constraints.constraints import (
    JointConstraint,
    MotionConstraints,
    OrientationConstraint,
    PositionConstraint,
)
from arm_planning.kinematics.inverse import InverseKinematics
from arm_planning.request import PlanRequest
from arm_planning.scene.objects import PlacedShape
from arm_planning.scene.shapes import Sphere
from arm_planning.timing.driven_spline import DrivenSpline

AXES = {
    "j1": ("0 0 1", "0 0 0.2"),
    "j2": ("0 1 0", "0 0 0.1"),
    "j3": ("0 1 0", "0 0 0.4"),
    "j4": ("1 0 0", "0.3 0 0"),
    "j5": ("0 1 0", "0.1 0 0"),
    "j6": ("1 0 0", "0.1 0 0"),
}
NAMES = tuple(AXES)
ARM = robot(
    link("base"),
    *(link(f"l{name[1]}") for name in NAMES),
    *(
        joint(
            name,
            "base" if name == "j1" else f"l{int(name[1]) - 1}",
            f"l{name[1]}",
            xyz=xyz,
            axis=axis,
        )
        for name, (axis, xyz) in AXES.items()
    ),
)
MODEL = model_of(ARM, arm=(NAMES, "l6"), shoulder=(("j1", "j2"), "l2"))
READY = dict(zip(NAMES, (0.2, 0.3, 0.4, 0.1, 0.8, 0.0), strict=True))
START = np.array(list(READY.values()))
KINEMATICS = InverseKinematics(MODEL, "arm")
TIP = KINEMATICS.tip_pose(START)


def point(offset, at=TIP):
    x, y, z = np.array(at.position) + offset
    return PlacedShape(Sphere(1e-3), RigidTransform((float(x), float(y), float(z))))


def pose_goal(offset, rotation=TIP.rotation, link="l6", at=TIP):
    """The tip's pose at the start, moved."""
    return MotionConstraints(
        positions=(PositionConstraint(link, (0.0, 0.0, 0.0), (point(offset, at),)),),
        orientations=(OrientationConstraint(link, rotation, (1e-3,) * 3),),
    )


def joint_goal(*positions, names=NAMES):
    return MotionConstraints(
        joints=tuple(
            JointConstraint(name, position, 0.0, 0.0)
            for name, position in zip(names, positions, strict=True)
        )
    )


def auxiliary(name, offset, link="l6"):
    """Path constraints with the point of CIRC."""
    return MotionConstraints(
        positions=(PositionConstraint(link, (0.0, 0.0, 0.0), (point(offset),)),), name=name
    )


def asked(planner, goal, **options):
    return PlanRequest("arm", (goal,), planner=planner, **options)


def tip_offsets(trajectory, count=300):
    """Where the tip is on the way, relative to the start, (count, 3)."""
    times = np.linspace(0.0, trajectory.duration_s, count)
    states = DrivenSpline.of(trajectory).sample(times)[0]
    return np.array([KINEMATICS.tip_pose(q).position for q in states]) - TIP.position
