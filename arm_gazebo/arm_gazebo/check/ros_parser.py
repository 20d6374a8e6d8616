"""Find what this project reads, but ROS's own parser (urdfdom) does not.

Such a file works here and fails beside a real robot_state_publisher. The rules were found by giving
each kind of text to urdfdom's `check_urdf`. It refuses a file for an error in a joint, and goes on
without the whole <inertial>, <visual>, <collision> or colour for one in a link.
"""

import re
from collections.abc import Iterator

from arm_description.urdf.description import RobotDescription
from arm_description.urdf.element import QUATERNION, UrdfElement
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


def refused_by_ros(description: RobotDescription) -> Iterator[Finding]:
    """Yield what urdfdom refuses or leaves out in silence of a description that is read here."""
    robot = description.root
    version = robot.get("version", VERSION)
    if robot.tag == "robot" and version != VERSION:
        yield _finding(robot, "<robot>", f"has version='{version}'; Jazzy knows only {VERSION}")
    for dynamics in robot.find("joint/dynamics"):
        if not dynamics.attributes.keys() & {"damping", "friction"}:
            yield _finding(dynamics, dynamics.label, "has neither damping nor friction")
    for safety in robot.find("joint/safety_controller"):
        if "k_velocity" not in safety.attributes:
            yield _finding(safety, safety.label, "has no k_velocity")
    for material in robot.find("link/visual/material"):
        if not material.get("name"):
            yield _finding(material, material.label, "has no name")
    # Parsed elements no longer have the tabs and line ends in them.
    yield from _blanks(description.text)


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


def _finding(element: UrdfElement, name: str, problem: str) -> Finding:
    message = f"{problem}; {NOT_ACCEPTED}"
    return Finding(BuildOutcome.DOUBTFUL, name, message, element.line)
