"""The names of classes in snapshots and recordings, those of earlier builds among them.

A class is stored as 'module:Name'. When a class moves or gets another name, its old name goes into
`EARLIER_NAMES`, and when an attribute gets another name, the old one into `EARLIER_ATTRIBUTES`, so
that the files of earlier builds stay readable.
"""

import importlib
import sys
from collections.abc import Mapping
from typing import Any

PACKAGES = ("arm_control", "arm_description", "arm_gazebo", "arm_node", "arm_sim")
"""Packages that reading a file may import."""

_CONTROLLERS = "arm_control.controllers"
_TRAJECTORY = f"{_CONTROLLERS}.joint_trajectory"
_SENSORS = f"{_CONTROLLERS}.sensor_broadcasters"

EARLIER_NAMES: dict[str, str] = {
    f"{_CONTROLLERS}.diff_drive.speed_limits": f"{_CONTROLLERS}.diff_drive.parameters",
    f"{_CONTROLLERS}.pid_controller.parameters": f"{_CONTROLLERS}.pid_controller.controller",
    f"{_TRAJECTORY}.execution": f"{_TRAJECTORY}.goals",
    f"{_TRAJECTORY}.execution:Execution": f"{_TRAJECTORY}.tracking:ActiveTrajectory",
    f"{_TRAJECTORY}.goals:TrajectoryRequest": f"{_TRAJECTORY}.trajectory:TrajectoryRequest",
    f"{_TRAJECTORY}.goals:WayPoints": f"{_TRAJECTORY}.trajectory:WayPoints",
    f"{_TRAJECTORY}.plans": f"{_TRAJECTORY}.profiles",
    f"{_TRAJECTORY}.plans:JoinedPlan": f"{_TRAJECTORY}.profiles:JoinedProfile",
    f"{_TRAJECTORY}.plans:SplinePlan": f"{_TRAJECTORY}.profiles:SplineProfile",
    f"{_TRAJECTORY}.plans:StepPlan": f"{_TRAJECTORY}.profiles:StepProfile",
    f"{_TRAJECTORY}.plans:StopPlan": f"{_TRAJECTORY}.profiles:StopProfile",
    f"{_TRAJECTORY}.tolerances": f"{_TRAJECTORY}.goals",
    f"{_SENSORS}.force_torque": f"{_SENSORS}.controller",
    f"{_SENSORS}.imu": f"{_SENSORS}.controller",
    "arm_gazebo.assembly.robot_settings": "arm_gazebo.run.settings",
    "arm_gazebo.model.saved_model": "arm_gazebo.model.built_model",
    "arm_gazebo.run.robot_settings": "arm_gazebo.run.settings",
    "arm_gazebo.spec.physics_timing": "arm_gazebo.physics_timing",
    "arm_gazebo.recording.recorded_run:RecordedRobot": "arm_gazebo.run.robot:ManagedRobot",
}
"""The present names of modules and classes, the latter as 'module:Name', by their earlier ones."""

EARLIER_ATTRIBUTES: dict[str, dict[str, str]] = {
    f"{_TRAJECTORY}.tracking:ActiveTrajectory": {"plan": "profile"},
    f"{_TRAJECTORY}.tracking:TrajectoryTracker": {
        "_commander": "_writer",
        "_execution": "_active",
        "_goals": "_goal",
    },
}
"""The present names of attributes by their earlier ones, for each class by its present name."""


def class_name(cls: type) -> str:
    """Return the name of a class for `class_named`: 'module:Name'."""
    return f"{cls.__module__}:{cls.__qualname__}"


def class_named(name: str) -> Any:
    """Return the object named 'module:Name', or None if there is none; see `PACKAGES`.

    Raises:
        ImportError: a module of the suite does not exist, or cannot be imported.
    """
    earlier_module, _, earlier_qualified = name.partition(":")
    moved = f"{EARLIER_NAMES.get(earlier_module, earlier_module)}:{earlier_qualified}"
    module_name, _, qualified = EARLIER_NAMES.get(name, moved).partition(":")
    if module_name.partition(".")[0] in PACKAGES:
        found: Any = importlib.import_module(module_name)
    else:
        found = sys.modules.get(module_name)
    for part in qualified.split("."):
        found = getattr(found, part, None)
    return found


def attributes_by_present_name(cls: type, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the stored attributes of an object of this class under their present names."""
    present = EARLIER_ATTRIBUTES.get(class_name(cls), {})
    return {present.get(name, name): value for name, value in given.items()}
