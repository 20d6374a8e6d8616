"""Report shapes whose margin and gap mean something else than they did in MuJoCo 3.8."""

import mujoco

from arm_gazebo.spec.report import BuildReport


def report_margins(spec: mujoco.MjSpec, file: str, report: BuildReport) -> None:
    """Report the geoms and pairs of an MJCF that have both a margin and a gap.

    Args:
        spec: the specification that was read from it.
        file: its name.
        report: receives one warning for each kind of element.
    """
    for kind, elements in (("geom", spec.geoms), ("pair", spec.pairs)):
        both = [element for element in elements if element.margin > 0.0 and element.gap > 0.0]
        if not both:
            continue
        first = both[0]
        name = f" '{first.name}'" if first.name else ""
        more = f" and {len(both) - 1} more" if len(both) > 1 else ""
        before = first.margin - first.gap
        report.warn(
            f"{kind}{name} of {file}{more}",
            f"it pushes at {first.margin:g} m from its surface, the margin. Up to MuJoCo 3.8 it "
            f"pushed at margin minus gap, {before:g} m: for that write margin='{before:g}'",
        )
