"""Find what this project reads, but ROS's own parser (urdfdom) does not.

Such a file works here and fails beside a real robot_state_publisher. The rules were found by giving
each kind of text to urdfdom's `check_urdf`. It refuses a file for an error in a joint, and goes on
without the whole <inertial>, <visual>, <collision> or colour for one in a link.
"""

import re
from collections.abc import Iterator
from typing import Any

from arm_description.urdf.element import QUATERNION, written_name
from arm_gazebo.build_report import BuildOutcome, Finding

VERSION = "1.0"
"""The only version that Jazzy's urdfdom accepts."""
VECTORS = ("xyz", "rpy", "size", "scale", "rgba", QUATERNION)
NUMBERS = {
    "mass": ("value",),
    "inertia": ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"),
    "cylinder": ("radius", "length"),
    "sphere": ("radius",),
    "limit": ("lower", "upper", "effort", "velocity"),
    "dynamics": ("damping", "friction"),
    "mimic": ("multiplier", "offset"),
    "safety_controller": ("soft_lower_limit", "soft_upper_limit", "k_position", "k_velocity"),
}
NOT_ACCEPTED = "urdfdom, which a real robot_state_publisher uses, does not accept that"
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_TAG = re.compile(r"""<([A-Za-z]\w*)((?:\s+[\w:.-]+\s*=\s*(?:"[^"<]*"|'[^'<]*'))+)\s*/?>""")
_ATTRIBUTE = re.compile(r"""([\w:.-]+)\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_OTHER_BLANK = re.compile(r"[^\S ]|&#0*(?:9|10|13);|&#[xX]0*(?:9|[aA]|[dD]);")


def refused_by_ros(text: str, robot: Any) -> Iterator[Finding]:
    """Yield what urdfdom refuses or leaves out in silence of a description that is read here.

    Args:
        text: the description; a parsed document no longer has the tabs and line ends in it.
        robot: its <robot> element.
    """
    version = robot.get("version", VERSION)
    if robot.tag == "robot" and version != VERSION:
        yield _finding(robot, "<robot>", f"has version='{version}'; Jazzy knows only {VERSION}")
    for dynamics in robot.iterfind("joint/dynamics"):
        if dynamics.get("damping") is None and dynamics.get("friction") is None:
            yield _finding(dynamics, _of_joint(dynamics), "has neither damping nor friction")
    for safety in robot.iterfind("joint/safety_controller"):
        if safety.get("k_velocity") is None:
            yield _finding(safety, _of_joint(safety), "has no k_velocity")
    for material in robot.iterfind("link/visual/material"):
        if not material.get("name"):
            link = material.getparent().getparent().get("name")
            where = f"<material> of link '{link}'"
            yield _finding(material, where, "has no name")
    yield from _blanks(text)


def _blanks(text: str) -> Iterator[Finding]:
    """Yield the numbers that other blanks than spaces separate, and those with one behind them."""
    text = _COMMENT.sub(lambda comment: "\n" * comment.group().count("\n"), text)
    line, position = 1, 0
    for tag in _TAG.finditer(text):
        name = tag.group(1)
        for key, *values in _ATTRIBUTE.findall(tag.group(2)):
            value = "".join(values)
            if key in VECTORS and _OTHER_BLANK.search(value):
                problem = "a tab or a line end between its numbers"
            elif key in NUMBERS.get(name, ()) and value != value.rstrip():
                problem = "a blank behind its number"
            else:
                continue
            line, position = line + text.count("\n", position, tag.start()), tag.start()
            shown = " ".join(value.split())
            message = f"has {problem} in {key}='{shown}'; {NOT_ACCEPTED}"
            yield Finding(BuildOutcome.DOUBTFUL, f"<{name}>", message, line)


def _of_joint(element: Any) -> str:
    return f"<{written_name(element)}> of joint '{element.getparent().get('name')}'"


def _finding(element: Any, name: str, problem: str) -> Finding:
    message = f"{problem}; {NOT_ACCEPTED}"
    return Finding(BuildOutcome.DOUBTFUL, name, message, int(element.sourceline or 0))
