"""Does everybody get the robot's description?"""

import xml.etree.ElementTree as ET
from dataclasses import dataclass

from arm_cli.doctor.finding import Finding
from arm_cli.doctor.observation import Observation

NAME = "description"
FIX = (
    "start the state publisher, as arm launch does: "
    'robot_state_publisher --ros-args -p robot_description:="$(xacro FILE)"'
)


@dataclass(frozen=True, slots=True)
class DescriptionPublished:
    """Looks at what came on /robot_description, in every namespace."""

    observation: Observation

    def examine(self) -> Finding:
        """Look whether there is one, and whether it is a robot."""
        found = self.observation.descriptions
        if not found:
            return Finding.error(NAME, "nobody publishes /robot_description", FIX)
        for topic, text in found.items():
            if not text:
                return Finding.error(
                    NAME,
                    f"{topic} has a publisher, but no description came",
                    "publish it with durability transient_local, for those who come later",
                )
            fault = _fault(text)
            if fault:
                return Finding.error(
                    NAME, f"{topic} is no URDF: {fault}", "look at the file with: arm check FILE"
                )
        return Finding.ok(NAME, f"a robot on {', '.join(found)}")


def _fault(text: str) -> str:
    try:
        root = ET.fromstring(text)
    except ET.ParseError as error:
        return str(error)
    if root.tag != "robot":
        return f"its root element is <{root.tag}>"
    return "" if root.find("link") is not None else "it has no <link>"
