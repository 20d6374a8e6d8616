"""How a goal ends once its trajectory has: only where the joints have followed it.

Without a goal tolerance, ros2_controllers ends a goal by time alone. Here a joint that rests far
from its end, because something blocks it or nothing drives it, does not count as arrived. One that
is late but comes closer does.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm_control.controllers.joint_trajectory.configuration import Configuration
from arm_control.controllers.joint_trajectory.execution import Execution, ExecutionStatus
from arm_control.controllers.joint_trajectory.goals import (
    GOAL_REACHED,
    GoalResult,
    not_checkable,
    stalled,
)
from arm_control.controllers.joint_trajectory.plans import POSITION, RESOLUTION_S

FAR = {"rad": 0.05, "m": 0.005}
"""A joint farther than this from its end may have stalled; closer, it is a controller's error."""
STALL_S = 0.5
"""How long such a joint has to come closer."""
CLOSER = 0.1
"""By which fraction of its distance it must have come closer by then."""


def result_at_end(
    status: ExecutionStatus,
    execution: Execution,
    error: NDArray[np.float64],
    unmeasured: Sequence[str],
    configuration: Configuration,
) -> GoalResult | None:
    """Return the result of a goal whose plan has ended; None while it has none yet.

    Args:
        status: GOAL_REACHED or SETTLING.
        execution: the goal's execution; it notes where far joints were.
        error: errors of the checked quantities, shape (k, n).
        unmeasured: names of the states that are not numbers.
        configuration: of the controller.
    """
    if unmeasured:
        too_late = execution.late_s > execution.tolerances.goal_time_s - RESOLUTION_S
        return not_checkable(unmeasured) if too_late else None
    if status is not ExecutionStatus.GOAL_REACHED:
        return None
    distance = np.abs(error[POSITION])
    far = _far(distance, execution, configuration)
    if not far.any():
        return GOAL_REACHED
    if execution.far_at_end is None:
        execution.far_at_end, execution.far_since_s = distance, execution.late_s
        return None
    if execution.late_s - execution.far_since_s < STALL_S - RESOLUTION_S:
        return None
    resting = far & (distance > (1.0 - CLOSER) * execution.far_at_end)
    if not resting.any():
        return GOAL_REACHED
    joint = int(np.flatnonzero(resting)[0])
    model = configuration.model
    return stalled(model.joints[joint], float(distance[joint]), model.units[joint])


def _far(
    distance: NDArray[np.float64], execution: Execution, configuration: Configuration
) -> NDArray[np.bool_]:
    """Return which commanded joints without a goal tolerance are far from their end."""
    far = distance > np.array([FAR[unit] for unit in configuration.model.units])
    is_commanded = np.zeros(len(far), dtype=bool)
    is_commanded[configuration.interfaces.commanded] = True
    return far & is_commanded & np.isinf(execution.tolerances.goal.values[POSITION])
