"""Find what is not read of a description: by the simulation, or by ROS's own parser (urdfdom).

A file that urdfdom does not read works here and fails beside a real robot_state_publisher. The
rules were found by giving each kind of text to urdfdom's `check_urdf`. It refuses a file for an
error in a joint, and goes on without the whole <inertial>, <visual>, <collision> or colour for one
in a link.
"""

import re
from collections.abc import Iterator
from typing import Any

from arm_description.urdf.description import RobotDescription
from arm_description.urdf.element import QUATERNION, UrdfElement
from arm_gazebo.build_report import BuildOutcome, Finding, as_one
from arm_gazebo.sensors.reader import sensor_type
from arm_gazebo.sensors.tags import COLOR_FORMATS

UNUSED = "the simulation does not use it"
ROBOT = "<robot>"
_SHAPES = {
    "origin": {},
    "geometry": {"box": {}, "cylinder": {}, "sphere": {}, "capsule": {}, "mesh": {}},
}
_MATERIAL = {"color": {}, "texture": {}}
# A tree of the elements that are read; other readers check the children of a None.
_READ: dict[str, Any] = {
    "material": _MATERIAL,
    "link": {
        "inertial": {"origin": {}, "mass": {}, "inertia": {}},
        "visual": {**_SHAPES, "material": _MATERIAL},
        "collision": {**_SHAPES, "material": None},
    },
    "joint": {
        **{"origin": {}, "parent": {}, "child": {}, "axis": {}, "limit": {}},
        **{"dynamics": {}, "mimic": {}, "safety_controller": {}},
    },
    "gazebo": None,
    "ros2_control": None,
    "transmission": None,
}
# The attributes of those elements.
_ATTRIBUTES = {
    "robot": ("name", "version"),
    "material": ("name",),
    "color": ("rgba",),
    "texture": ("filename",),
    "link": ("name",),
    "inertial": (),
    "mass": ("value",),
    "inertia": ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"),
    "visual": ("name",),
    "collision": ("name",),
    "origin": ("xyz", "rpy", QUATERNION),
    "geometry": (),
    "box": ("size",),
    "cylinder": ("radius", "length"),
    "sphere": ("radius",),
    "capsule": ("radius", "length"),
    "mesh": ("filename", "scale"),
    "joint": ("name", "type"),
    "parent": ("link",),
    "child": ("link",),
    "axis": ("xyz",),
    "limit": ("lower", "upper", "effort", "velocity"),
    "dynamics": ("damping", "friction"),
    "mimic": ("joint", "multiplier", "offset"),
    "safety_controller": ("soft_lower_limit", "soft_upper_limit", "k_position", "k_velocity"),
}


def unread_elements(description: RobotDescription) -> tuple[Finding, ...]:
    """Return elements that are not read, and elements without a meaning in a simulation.

    For elements that repeat at many links or joints, the first is named and the others counted.
    """
    root = description.root
    groups: dict[str, list[Finding]] = {}
    own = _unknown_attributes(root, ROBOT) if root.tag == "robot" else ()
    for kind, finding in (*own, *_unknown(root, _READ, ROBOT), *_meaningless(description)):
        groups.setdefault(kind, []).append(finding)
    return tuple(map(as_one, groups.values()))


def _unknown(
    element: UrdfElement, read: dict[str, Any], owner: str
) -> Iterator[tuple[str, Finding]]:
    for child in element.elements:
        name = child.tag
        if child.is_foreign:
            # The reader of the description reports it.
            continue
        if name not in read:
            yield name, _dropped(child, f"<{name}> in {owner}", UNUSED)
        elif read[name] is not None:
            called = child.get("name")
            here = f"{name} '{called}'" if called and owner == ROBOT else owner
            yield from _unknown_attributes(child, here)
            yield from _unknown(child, read[name], here)


def _unknown_attributes(element: UrdfElement, owner: str) -> Iterator[tuple[str, Finding]]:
    tag = element.tag
    for key in element.attributes:
        # "{...}" is a namespace.
        if key not in _ATTRIBUTES[tag] and not key.startswith("{"):
            what = owner if owner.startswith((f"{tag} ", f"<{tag}>")) else f"<{tag}> of {owner}"
            yield f"{tag} {key}", _dropped(element, f"{key}='{element.get(key)}' of {what}", UNUSED)


def _meaningless(description: RobotDescription) -> Iterator[tuple[str, Finding]]:
    root = description.root
    for element in root.children("transmission"):
        name = f"transmission '{element.attributes.get('name')}'"
        reason = "joints are driven directly; <ros2_control> defines what is commanded"
        yield "transmission", _dropped(element, name, reason)
    for element in root.find("joint/safety_controller"):
        reason = "the joint stops at its <limit>; soft limits need enforce_command_limits"
        yield "safety_controller", _dropped(element, element.label, reason)
    yield from _mimics_of_hardware(root)
    for material in root.inside():
        for element in material.children("texture") if material.tag == "material" else ():
            yield "texture", _dropped(element, "<texture>", "surfaces have a colour, not a texture")
    for element in root.find("gazebo/sensor"):
        if sensor_type(element) is None:
            name, kind = (f"'{element.attributes.get(key)}'" for key in ("name", "type"))
            name = f"sensor {name}"
            yield name, _dropped(element, name, f"its type {kind} is not simulated")
        elif sensor_type(element) == "camera":
            images = (image for image in element.inside() if image.tag == "image")
            for wanted in (wanted for image in images for wanted in image.children("format")):
                word = wanted.content
                if word and word not in COLOR_FORMATS:
                    name = f"<format> of camera '{element.attributes.get('name')}'"
                    yield "format", _dropped(wanted, name, f"images are rgb8, not {word}")


def _mimics_of_hardware(root: UrdfElement) -> Iterator[tuple[str, Finding]]:
    followers = {joint.get("name") for joint in root.children("joint") if joint.first("mimic")}
    for joint in root.find("ros2_control/joint"):
        mimics = [each for each in joint.children("param") if each.get("name") == "mimic"]
        marks = ['<param name="mimic">' for _ in mimics]
        if joint.text("mimic").lower() == "true":
            marks.append('mimic="true"')
        if marks and joint.get("name") not in followers:
            name = f"{marks[0]} of <ros2_control> joint '{joint.get('name')}'"
            reason = "it has no effect: since ROS 2 Jazzy only <mimic> in the URDF's joint counts"
            yield marks[0], Finding(BuildOutcome.DOUBTFUL, name, reason, joint.line)


def _dropped(element: UrdfElement, name: str, reason: str) -> Finding:
    return Finding(BuildOutcome.DROPPED, name, reason, element.line)


VERSION = "1.0"
"""The only version that Jazzy's urdfdom accepts."""
VECTORS = ("xyz", "rpy", "size", "scale", "rgba", QUATERNION)
_OF_NUMBERS = ("mass", "inertia", "cylinder", "sphere", "limit", "dynamics", "safety_controller")
NUMBERS = {**{tag: _ATTRIBUTES[tag] for tag in _OF_NUMBERS}, "mimic": ("multiplier", "offset")}
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
