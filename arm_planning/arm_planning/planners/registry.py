"""The planners by the ids that requests give."""

import importlib.util
import math
from collections.abc import Mapping

from arm_node.names import describe_known
from arm_planning.errors import NoPlanError, SettingError
from arm_planning.planners.problem import PathPlanner
from arm_planning.planners.search import RrtConnectPlanner

DEFAULT = "RRTConnect"
"""The suite's own planner."""
RANGE, GOAL_BIAS = "range", "goal_bias"
DECORATIONS = ("geometric::", "kConfigDefault")
"""What OMPL's type names and MoveIt's configurations put around a planner's name."""


def planner_ids() -> tuple[str, ...]:
    """Return the planners that there are, the default first."""
    return (DEFAULT, *(name for name in _ompl_names() if name != DEFAULT))


def planner_name(planner_id: str) -> str:
    """Return the name of the planner that an id means.

    Args:
        planner_id: "" for the default; "RRTstar", and as in MoveIt's configurations
            "geometric::RRTstar" or "RRTstarkConfigDefault".
    """
    name = planner_id
    for decoration in DECORATIONS:
        name = name.removeprefix(decoration).removesuffix(decoration)
    return name or DEFAULT


def planner_for(planner_id: str, parameters: Mapping[str, float] | None = None) -> PathPlanner:
    """Return a planner.

    Args:
        planner_id: as for `planner_name`.
        parameters: of those that `planner_parameters` names; others are passed over.

    Raises:
        PlanningError: there is no such planner; the message names those that exist.
    """
    name = _known(planner_id)
    known = _defaults(name)
    given = {key: value for key, value in (parameters or {}).items() if key in known}
    if name == DEFAULT:
        reach = given.get(RANGE, 0.0)
        return RrtConnectPlanner(reach) if reach else RrtConnectPlanner()
    from arm_planning.planners.ompl.planner import OmplPlanner

    return OmplPlanner(name, given)


def planner_parameters(planner_id: str) -> dict[str, float]:
    """Return the parameters that a planner takes, with their defaults.

    They are OMPL's: "range", the longest move of a tree in the joints' units, 0 for the planner's
    own choice; and "goal_bias", the share of random states that are goals.

    Raises:
        PlanningError: there is no such planner; the message names those that exist.
    """
    return _defaults(_known(planner_id))


def checked_parameter(planner_id: str, name: str, text: str) -> float:
    """Return the value of a planner's parameter.

    Raises:
        PlanningError: there is no such planner or parameter, or the text is not a value for it.
    """
    known = planner_parameters(planner_id)
    if name not in known:
        what = describe_known(name, known, "it has") if known else "it has none"
        raise SettingError(
            f"the planner {planner_name(planner_id)} has no parameter '{name}'; {what}"
        )
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    most = 1.0 if name == GOAL_BIAS else math.inf
    if not 0.0 <= value <= most or math.isinf(value):
        kind = "a number from 0 to 1" if name == GOAL_BIAS else "a number from 0"
        raise SettingError(f"{name} is '{text}'; it is {kind}")
    return value


def _defaults(name: str) -> dict[str, float]:
    if name == DEFAULT:
        return {RANGE: 0.0}
    from arm_planning.planners.ompl.planner import takes_goal_bias, takes_range

    return ({RANGE: 0.0} if takes_range(name) else {}) | (
        {GOAL_BIAS: 0.05} if takes_goal_bias(name) else {}
    )


def _known(planner_id: str) -> str:
    name, names = planner_name(planner_id), _ompl_names()
    if name == DEFAULT or name in names:
        return name
    hint = "" if names else "; more come with OMPL: pip install 'arm-suite[ompl]'"
    raise NoPlanError(f"no planner '{planner_id}'; {describe_known(name, planner_ids())}{hint}")


def _ompl_names() -> tuple[str, ...]:
    if importlib.util.find_spec("ompl") is None:
        return ()
    from arm_planning.planners.ompl.planner import planner_names

    return planner_names()
