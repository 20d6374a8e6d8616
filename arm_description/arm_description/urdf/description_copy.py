"""Copy a robot's description, with names that are unique beside the original's."""

from collections.abc import Iterator
from dataclasses import dataclass

import lxml.etree as etree

from arm_description.urdf.description_source import source_of, with_source
from arm_description.urdf.xml_document import parse_xml

WORLD_LINK = "world"
"""The name of a root link that is the world itself, which all copies share."""
NAMED = ("link", "joint")
"""Elements whose attribute `name` is the name of a link or a joint."""
REFERENCES = ("link", "joint", "reference")
"""Attributes that name a link or a joint."""
NAMING_TEXTS = (
    *("parent", "child", "link", "joint", "joint_name", "param"),
    *("frame_id", "gz_frame_id", "ignition_frame_id", "optical_frame_id", "frameName"),
)
"""Elements whose text may be the name of a link or a joint."""
TOPIC = "topic"
"""The end of the name of elements with a sensor's topic."""


@dataclass(frozen=True, slots=True)
class DescriptionCopy:
    """A copy of a description.

    Attributes:
        name: the name of the copied robot.
        text: its URDF.
        names: new names of links and joints by their names in the original.
    """

    name: str
    text: str
    names: dict[str, str]


def copy_description(urdf: str, name: str) -> DescriptionCopy:
    """Return a description whose links and joints have the prefix NAME_, and whose robot is NAME.

    A root link `world` keeps its name. Absolute topics of sensors become relative, so that each
    copy can have its own in its namespace.

    Args:
        urdf: description of a robot.
        name: name of the copy.

    Raises:
        XmlError: the text is not XML.
    """
    document = parse_xml(urdf)
    children = {element.get("link") for element in document.iterfind("joint/child")}
    names = {
        original: f"{name}_{original}"
        for original in _links_and_joints(document)
        if original != WORLD_LINK or original in children
    }
    document.set("name", name)
    for element in document.iter("*"):
        _rename(element, names)
    for element in document.iterfind("gazebo//*"):
        if str(element.tag).endswith(TOPIC) and element.text:
            element.text = element.text.strip().lstrip("/")
    text = etree.tostring(document, encoding="unicode")
    source = source_of(urdf)
    if source.file is not None:
        text = with_source(text, source.file, source.package_path)
    return DescriptionCopy(name, text, names)


def _links_and_joints(document: etree._Element) -> Iterator[str]:
    for kind in NAMED:
        yield from (str(element.get("name", "")) for element in document.iterfind(kind))


def _rename(element: etree._Element, names: dict[str, str]) -> None:
    for attribute in (*REFERENCES, *(("name",) if element.tag in NAMED else ())):
        value = element.get(attribute)
        if value in names:
            element.set(attribute, names[value])
    text = (element.text or "").strip()
    if element.tag in NAMING_TEXTS and text in names:
        element.text = names[text]
