"""Find the elements of a description that no part of the simulation reads."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from arm_description.urdf.description import RobotDescription
from arm_description.urdf.element import QUATERNION, UrdfElement
from arm_gazebo.build_report import BuildOutcome, Finding
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
        "origin": {},
        "parent": {},
        "child": {},
        "axis": {},
        "limit": {},
        "dynamics": {},
        "mimic": {},
        "safety_controller": {},
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
    return tuple(_counted(group) for group in groups.values())


def _counted(group: Sequence[Finding]) -> Finding:
    first, others = group[0], len(group) - 1
    return replace(first, element=f"{first.element} and {others} more") if others else first


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
