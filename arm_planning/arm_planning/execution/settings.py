"""The parameters of MoveIt's trajectory execution."""

from collections.abc import Mapping
from dataclasses import dataclass

from arm_planning.execution.controllers import TrajectoryController
from arm_planning.setting_values import number, switch

EXECUTION = "trajectory_execution"
"""What the names of these parameters begin with."""
MONITORING = "execution_duration_monitoring"


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
        """Return the settings of parameters named as in MoveIt; missing ones have defaults.

        Raises:
            SettingError: a value has the wrong type or sign.
        """
        default = cls()

        def least_0(name: str, otherwise: float) -> float:
            return number(f"{EXECUTION}.{name}", values.get(name, otherwise), least=0.0)

        return cls(
            least_0("allowed_execution_duration_scaling", default.duration_scaling),
            least_0("allowed_goal_duration_margin", default.duration_margin_s),
            least_0("allowed_start_tolerance", default.start_tolerance),
            switch(f"{EXECUTION}.{MONITORING}", values.get(MONITORING, default.monitors_duration)),
        )

    def longest_s(self, duration_s: float, controller: TrajectoryController) -> float:
        """Return how long a controller may take for a motion of a duration, in s."""
        scaling, margin_s = controller.duration_scaling, controller.duration_margin_s
        scaling = self.duration_scaling if scaling is None else scaling
        return duration_s * scaling + (self.duration_margin_s if margin_s is None else margin_s)
