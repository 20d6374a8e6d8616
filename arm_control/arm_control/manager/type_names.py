"""Tells a misspelt type of a controller from one of a package that the suite does not have.

Files of real robots name controllers that are C++ plugins; the rest of such a file is of use. A
type that the user has misspelt is a mistake.
"""

import re
from collections.abc import Collection

ONLY_IN_CPP = frozenset(
    {
        "ackermann_steering_controller/AckermannSteeringController",
        "admittance_controller/AdmittanceController",
        "bicycle_steering_controller/BicycleSteeringController",
        "chained_filter_controller/ChainedFilter",
        "effort_controllers/JointEffortController",
        "effort_controllers/JointPositionController",
        "effort_controllers/JointTrajectoryController",
        "effort_controllers/JointVelocityController",
        "force_torque_sensor_controller/ForceTorqueSensorController",
        "gpio_controllers/GpioToolController",
        "gps_sensor_broadcaster/GPSSensorBroadcaster",
        "imu_sensor_controller/ImuSensorController",
        "joint_state_controller/JointStateController",
        "motion_primitives_controllers/MotionPrimitivesForwardController",
        "motion_primitives_controllers/MotionPrimitivesFromTrajectoryController",
        "omni_wheel_drive_controller/OmniWheelDriveController",
        "pose_broadcaster/PoseBroadcaster",
        "position_controllers/JointTrajectoryController",
        "range_sensor_broadcaster/RangeSensorBroadcaster",
        "state_interfaces_broadcaster/StateInterfacesBroadcaster",
        "tricycle_controller/TricycleController",
        "tricycle_steering_controller/TricycleSteeringController",
        "velocity_controllers/JointPositionController",
        "velocity_controllers/JointTrajectoryController",
        "velocity_controllers/JointVelocityController",
    }
)
"""Types of ros2_controllers, and of ROS 1's ros_controllers, that the suite does not have, although
it has some of their packages."""

SAME_BUT_FOR_TYPING = 0.92
"""Similarity, 1 for equal, from which a type of another package counts as misspelt."""
MIN_SIMILARITY = 0.8
_PLUGIN = re.compile(r"[A-Za-z]\w*(::\w+)*/[A-Za-z]\w*(::\w+)*")


def near_types(type_name: str, known: Collection[str]) -> tuple[str, ...]:
    """Return at most three types with similar names, or else of that class, or of that package."""
    # Imported here, as below, because the types of most files are known.
    from difflib import get_close_matches

    folded = {name.lower(): name for name in sorted(known)}
    text = type_name.strip().lower()
    package, _, class_name = text.rpartition("/")
    near = (
        get_close_matches(text, folded, 3, MIN_SIMILARITY)
        or [name for name in folded if name.rpartition("/")[2] == class_name]
        or [name for name in folded if name.partition("/")[0] == package]
    )
    return tuple(folded[name] for name in near[:3])


def is_misspelt(type_name: str, known: Collection[str]) -> bool:
    """Return whether an unknown type is the user's mistake, not one of a package that is missing.

    It is if it cannot be the name of a plugin, if the suite has its package but no such class in
    it, or if it differs from a known type by a letter or two.
    """
    if type_name in ONLY_IN_CPP:
        return False
    from difflib import SequenceMatcher

    packages = {name.partition("/")[0] for name in known}
    if not _PLUGIN.fullmatch(type_name) or type_name.partition("/")[0] in packages:
        return True
    return any(
        SequenceMatcher(None, type_name.lower(), name.lower()).ratio() >= SAME_BUT_FOR_TYPING
        for name in near_types(type_name, known)
    )


def unknown_type(type_name: str, known: Collection[str]) -> str:
    """Return a sentence's part about an unknown type: the near ones, or else all that exist."""
    near = near_types(type_name, known)
    if near:
        return f"no controller type '{type_name}'; did you mean {' or '.join(map(repr, near))}?"
    return f"no controller type '{type_name}'; known: {', '.join(sorted(known))}"
