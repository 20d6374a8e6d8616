"""The planners by the ids that requests give."""

import importlib.util

from arm_node.names import describe_known
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.planners.problem import PathPlanner
from arm_planning.planners.search import RrtConnectPlanner

DEFAULT = "RRTConnect"
"""The suite's own planner."""
DECORATIONS = ("geometric::", "kConfigDefault")
"""What OMPL's type names and MoveIt's configurations put around a planner's name."""


def planner_ids() -> tuple[str, ...]:
    """Return the planners that there are, the default first."""
    return (DEFAULT, *(name for name in _ompl_names() if name != DEFAULT))


def planner_for(planner_id: str) -> PathPlanner:
    """Return a planner.

    Args:
        planner_id: "" for the default; "RRTstar", and as in MoveIt's configurations
            "geometric::RRTstar" or "RRTstarkConfigDefault".

    Raises:
        PlanningError: there is no such planner; the message names those that exist.
    """
    name = planner_id
    for decoration in DECORATIONS:
        name = name.removeprefix(decoration).removesuffix(decoration)
    if name in ("", DEFAULT):
        return RrtConnectPlanner()
    names = _ompl_names()
    if name in names:
        from arm_planning.planners.ompl.planner import OmplPlanner

        return OmplPlanner(name)
    hint = "" if names else "; more come with OMPL: pip install 'arm-suite[ompl]'"
    raise PlanningError(
        MoveItErrorCode.PLANNING_FAILED,
        f"no planner '{planner_id}'; {describe_known(name, planner_ids())}{hint}",
    )


def _ompl_names() -> tuple[str, ...]:
    if importlib.util.find_spec("ompl") is None:
        return ()
    from arm_planning.planners.ompl.planner import planner_names

    return planner_names()
