"""The sentence that says why inverse kinematics found nothing, and how near it came."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from arm_node.names import listing
from arm_planning.kinematics.chain import Chain
from arm_planning.kinematics.descent import DescentEnd
from arm_planning.kinematics.search import Orientation, Search

Array = NDArray[np.float64]

AT_LIMIT = 1e-6
FULL_POSE_JOINTS = 6


def shortfall(
    search: Search, tip: str, joints: Sequence[str], lower: Array, upper: Array, chain: Chain
) -> str:
    """Return the sentence.

    Args:
        search: the search that found nothing.
        tip: the link that was to be placed.
        joints: the joints that move it.
        lower: their lower limits, (n,).
        upper: their upper limits, (n,).
        chain: their kinematics.
    """
    x, y, z = search.target.position
    place = f"({x:.3f}, {y:.3f}, {z:.3f}) m"
    exact = search.orientation is Orientation.EXACT
    turned = " in the given orientation" if exact else ""
    if search.blocked:
        found = (
            "the only solution found is"
            if search.blocked == 1
            else (f"all {search.blocked} solutions found are")
        )
        return f"link '{tip}' can reach {place}{turned}, but {found} in collision"
    best = search.best
    assert best is not None, "a search without solutions has failed descents"
    angle = f" and {_rounded(math.degrees(best.off_rad))} degrees" if exact else ""
    return (
        f"link '{tip}' cannot reach {place}{turned}: the best pose is off by "
        f"{_rounded(best.off_m * 1e3)} mm{angle}"
        + _too_short(search, chain)
        + _at_limits(best, joints, lower, upper)
        + _too_few(joints, exact)
    )


def _too_short(search: Search, chain: Chain) -> str:
    if not chain.is_too_short_for(search.target.position):
        return ""
    distance = float(np.linalg.norm(search.target.position - chain.anchor))
    return (
        f"; the place is {distance:.3f} m from the first joint, and the arm is "
        f"{chain.reach_m:.3f} m long"
    )


def _at_limits(best: DescentEnd, joints: Sequence[str], lower: Array, upper: Array) -> str:
    at_limit = (best.q - lower < AT_LIMIT) | (upper - best.q < AT_LIMIT)
    names = [name for name, at in zip(joints, at_limit, strict=True) if at]
    if not names:
        return ""
    be, plural = ("is", "") if len(names) == 1 else ("are", "s")
    return f"; there joint{plural} {listing(names)} {be} at the limit{plural}"


def _too_few(joints: Sequence[str], exact: bool) -> str:
    if not exact or len(joints) >= FULL_POSE_JOINTS:
        return ""
    return (
        f"; with {len(joints)} joints most orientations cannot be had at a place: ask for the "
        "nearest orientation, or for the position alone"
    )


def _rounded(number: float) -> str:
    """Return two digits of a number, and 0 for what nobody can measure."""
    if number >= 99.5:
        return f"{number:.0f}"
    return f"{number if number >= 1e-3 else 0.0:.2g}"
