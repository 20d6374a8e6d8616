"""A parsed robot description that all readers share, so that the text is parsed only once."""

import lxml.etree as etree

from arm_description.urdf.robot import Robot
from arm_description.urdf.xml_document import parse_document, unwrapped


class UrdfDocument:
    """The text of a URDF, its elements and, once `parse_urdf` has read it, its robot.

    Readers must not change the elements. Threads may share it once `robot` is set.

    Attributes:
        text: the URDF.
        source: the name of the text in messages.
        root: the <robot> element, or the outermost element if that is another one.
        is_wrapped: whether the <robot> is the only child of a <urdf>.
        robot: the result of `parse_urdf`; None before that.
    """

    def __init__(self, text: str, source: str = "robot_description") -> None:
        """Parse the text.

        Raises:
            XmlError: the text is not XML.
        """
        self.text = text
        self.source = source
        document = parse_document(text, source)
        self.root: etree._Element = unwrapped(document)
        self.is_wrapped = self.root is not document
        self.robot: Robot | None = None


Description = str | UrdfDocument
"""The argument of functions that read a description: its text, or its shared document."""


def as_document(description: Description, source: str = "robot_description") -> UrdfDocument:
    """Return the document of a description; parse it if it is a text.

    Raises:
        XmlError: the text is not XML.
    """
    if isinstance(description, UrdfDocument):
        return description
    return UrdfDocument(description, source)


def text_of(description: Description) -> str:
    """Return the text of a description."""
    return description.text if isinstance(description, UrdfDocument) else description
