"""What a description says that no part of the simulation reads."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from arm_description.urdf_element import written_name
from arm_description.xml_document import parse_xml
from arm_gazebo.build_report import Finding, Outcome
from arm_gazebo.sensors.tags import COLOR_FORMATS, sensor_type

_SHAPES = {
    "origin": {},
    "geometry": {"box": {}, "cylinder": {}, "sphere": {}, "capsule": {}, "mesh": {}},
}
_MATERIAL = {"color": {}, "texture": {}}
# A tree of the elements that are read; what is below a None is somebody else's to read.
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


def leftovers(urdf_xml: str, source: str = "robot_description") -> tuple[Finding, ...]:
    """Return what is left unread, and what is read but has no meaning in a simulation.

    Of what stands at every link or joint the first is named, and the others are counted.

    Raises:
        XmlError: the text is not XML.
    """
    root = parse_xml(urdf_xml, source)
    groups: dict[str, list[Finding]] = {}
    for kind, finding in (*_unknown(root, _READ, "<robot>"), *_meaningless(root)):
        groups.setdefault(kind, []).append(finding)
    return tuple(_counted(group) for group in groups.values())


def _counted(group: Sequence[Finding]) -> Finding:
    first, others = group[0], len(group) - 1
    return replace(first, element=f"{first.element} and {others} more") if others else first


def _unknown(element: Any, read: dict[str, Any], owner: str) -> Iterator[tuple[str, Finding]]:
    for child in element.iterchildren(tag="*"):
        name = written_name(child)
        if name not in read:
            yield name, _dropped(child, f"<{name}> in {owner}", "it is not part of a URDF")
        elif read[name] is not None:
            called = child.get("name")
            here = f"{name} '{called}'" if called and element.getparent() is None else owner
            yield from _unknown(child, read[name], here)


def _meaningless(root: Any) -> Iterator[tuple[str, Finding]]:
    for element in root.findall("transmission"):
        name = f"transmission '{element.get('name')}'"
        reason = "joints are driven directly; what is commanded stands in <ros2_control>"
        yield "transmission", _dropped(element, name, reason)
    for element in root.iterfind("joint/safety_controller"):
        name = f"<safety_controller> of joint '{element.getparent().get('name')}'"
        reason = "the joint stops at its <limit>; soft limits count under enforce_command_limits"
        yield "safety_controller", _dropped(element, name, reason)
    yield from _mimics_of_hardware(root)
    for element in root.iterfind(".//material/texture"):
        yield "texture", _dropped(element, "<texture>", "surfaces have a colour, no picture")
    for element in root.iterfind("gazebo/sensor"):
        if sensor_type(element) is None:
            name = f"sensor '{element.get('name')}'"
            yield (
                name,
                _dropped(element, name, f"its type '{element.get('type')}' is not simulated"),
            )
        elif sensor_type(element) == "camera":
            for wanted in element.iterfind(".//image/format"):
                word = str(wanted.text or "").strip()
                if word and word not in COLOR_FORMATS:
                    name = f"<format> of camera '{element.get('name')}'"
                    yield "format", _dropped(wanted, name, f"pictures are rgb8, not {word}")


def _mimics_of_hardware(root: Any) -> Iterator[tuple[str, Finding]]:
    followers = {mimic.getparent().get("name") for mimic in root.iterfind("joint/mimic")}
    for joint in root.iterfind("ros2_control/joint"):
        said = [f'<param name="{p.get("name")}">' for p in joint.iterfind("param[@name='mimic']")]
        if joint.get("mimic", "").strip().lower() == "true":
            said.append('mimic="true"')
        if said and joint.get("name") not in followers:
            name = f"{said[0]} of <ros2_control> joint '{joint.get('name')}'"
            reason = "it follows nobody: since ROS 2 Jazzy only <mimic> in the URDF's joint says so"
            line = int(joint.sourceline or 0)
            yield said[0], Finding(Outcome.DOUBTFUL, name, reason, line)


def _dropped(element: Any, name: str, reason: str) -> Finding:
    return Finding(Outcome.DROPPED, name, reason, int(element.sourceline or 0))
