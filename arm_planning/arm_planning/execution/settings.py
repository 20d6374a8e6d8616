"""The parameters of MoveIt's trajectory execution."""

from collections.abc import Mapping
from dataclasses import dataclass

from arm_planning.execution.controllers import TrajectoryController


@dataclass(frozen=True, slots=True)
class ExecutionSettings:
    """The values below `trajectory_execution`, with MoveIt's defaults.

    Attributes:
        duration_scaling: how many times its planned duration a motion may take.
        duration_margin_s: and how much longer, in the robot's time.
        start_tolerance: how far each joint may be from the first point, rad or m; 0 switches the
            check off.
        monitors_duration: whether a motion that takes longer is stopped.
    """

    duration_scaling: float = 1.1
    duration_margin_s: float = 0.5
    start_tolerance: float = 0.01
    monitors_duration: bool = True

    @classmethod
    def read(cls, values: Mapping[str, object]) -> "ExecutionSettings":
        """Return the settings of parameters named as in MoveIt; missing ones have defaults."""
        default = cls()
        monitors = values.get("execution_duration_monitoring", True)
        return cls(
            _number(values, "allowed_execution_duration_scaling", default.duration_scaling),
            _number(values, "allowed_goal_duration_margin", default.duration_margin_s),
            _number(values, "allowed_start_tolerance", default.start_tolerance),
            monitors is not False,
        )

    def longest_s(self, duration_s: float, controller: TrajectoryController) -> float:
        """Return how long a controller may take for a motion of a duration, in s."""
        scaling, margin_s = controller.duration_scaling, controller.duration_margin_s
        scaling = self.duration_scaling if scaling is None else scaling
        return duration_s * scaling + (self.duration_margin_s if margin_s is None else margin_s)


def _number(values: Mapping[str, object], name: str, default: float) -> float:
    value = values.get(name, default)
    if isinstance(value, int | float) and not isinstance(value, bool):
        return float(value)
    return default
