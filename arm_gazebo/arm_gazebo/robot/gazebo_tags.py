"""What `<gazebo>` tags say about the physics and looks of links; sensors are read elsewhere."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from arm_description.mesh_data import Color
from arm_description.names import listing
from arm_description.xml_document import parse_xml
from arm_gazebo.build_report import BuildReport, Finding
from arm_gazebo.robot.gazebo_materials import gazebo_color

SLIPPERIEST = 1e-5
ROUGHEST = 10.0
"""Nothing slides at a slope of 84 degrees; contacts of more are hard to solve."""
FRICTION_TAGS = ("mu", "mu1", "mu2")
SELF_COLLIDE_TAGS = ("selfCollide", "self_collide")
NEEDLESS_TAGS = frozenset(
    {
        "sensor",  # read by whoever simulates it
        "preserveFixedJoint",  # every frame is kept
        "disableFixedJointLumping",
        "disableJointLumping",
        "implicitSpringDamper",  # damping always is implicit
        "cfmDamping",
        "provideFeedback",
        "provide_feedback",
    }
)
NEEDLESS_PLUGINS = (
    "ros2_control",  # the hardware of <ros2_control> needs none
    "ros_control",
    "mimic",  # joints follow by themselves
    "sensors",  # as sensors do what they do
    "-imu-",
    "forcetorque",
    "-contact-",
    "joint-state-publisher",  # as joint_state_broadcaster
    "joint_state_publisher",
)
"""Parts of the names of Gazebo's plugins whose work is done without them."""
INSTEAD_OF_PLUGINS = {
    "diff": "; diff_drive_controller drives wheels",
    "joint-position": "; position_controllers/JointGroupPositionController moves joints",
    "joint-trajectory": "; joint_trajectory_controller follows trajectories",
}
REASONS = {
    "kp": "contacts have MuJoCo's own stiffness",
    "kd": "contacts have MuJoCo's own damping",
    "static": "base:=fixed bolts a robot down",
}


@dataclass(frozen=True, slots=True)
class LinkTags:
    """What is said about one link.

    Attributes:
        friction: coefficient of its collisions, None where nothing is said.
        self_collide: whether it touches other links of the robot.
        rgba: colour of all its visuals, None where nothing is said.
    """

    friction: float | None = None
    self_collide: bool = False
    rgba: Color | None = None


PLAIN = LinkTags()


@dataclass(frozen=True, slots=True)
class GazeboTags:
    """What is said about a robot.

    Attributes:
        links: by name, those about which something is said.
        self_collide: whether all links touch each other.
        findings: what cannot be simulated or makes no sense.
    """

    links: Mapping[str, LinkTags] = field(default_factory=dict)
    self_collide: bool = False
    findings: tuple[Finding, ...] = ()

    def link(self, name: str) -> LinkTags:
        """Return what is said about a link."""
        return self.links.get(name, PLAIN)


def parse_gazebo_tags(urdf_xml: str) -> GazeboTags:
    """Return what a description's <gazebo> elements say; nothing in them is an error.

    Raises:
        XmlError: the text is not XML.
    """
    root = parse_xml(urdf_xml)
    reader = _Reader({str(e.get("name")) for e in root if e.tag in ("link", "joint")})
    for gazebo in root.findall("gazebo"):
        reader.read(gazebo)
    return reader.tags()


class _Reader:
    """Collects the tags of one description."""

    def __init__(self, names: set[str]) -> None:
        self._names = names
        self._links: dict[str, LinkTags] = {}
        self._self_collide = False
        self._report = BuildReport()
        self._left_out: dict[str, list[int]] = {}

    def tags(self) -> GazeboTags:
        for tag, lines in self._left_out.items():
            reason = REASONS.get(tag, "it is not simulated")
            others = f" and {len(lines) - 1} more" if len(lines) > 1 else ""
            self._report.drop(f"<gazebo> <{tag}>{others}", reason, lines[0])
        return GazeboTags(self._links, self._self_collide, self._report.findings)

    def read(self, gazebo: Any) -> None:
        reference = str(gazebo.get("reference", "")).strip()
        if reference and reference not in self._names:
            self._report.warn(
                f"<gazebo reference='{reference}'>",
                f"no link or joint has this name; there are {listing(sorted(self._names))}",
                int(gazebo.sourceline or 0),
            )
            return
        before = self._links.get(reference, PLAIN)
        after = before
        for element in gazebo.iterchildren(tag="*"):
            after = self._take(after, element, reference)
        if reference and after != before:
            self._links[reference] = after

    def _take(self, tags: LinkTags, element: Any, reference: str) -> LinkTags:
        if element.tag in FRICTION_TAGS and reference:
            friction = self._friction(element)
            known = tags.friction
            # Contacts have one coefficient here; the slippery direction is the safe one.
            lowest = friction if known is None or friction is None else min(known, friction)
            return replace(tags, friction=known if lowest is None else lowest)
        if element.tag in SELF_COLLIDE_TAGS:
            wanted = _text(element).lower() in ("true", "1")
            self._self_collide |= wanted and not reference
            return replace(tags, self_collide=wanted)
        if element.tag == "material" or (element.tag == "visual" and reference):
            return replace(tags, rgba=self._color(element) or tags.rgba)
        if element.tag == "plugin":
            self._leave_out_plugin(element)
        elif element.tag == "sensor" and not reference:
            self._report.drop(
                f"<gazebo> <sensor name='{element.get('name')}'>",
                "no link carries it: its <gazebo> has no reference",
                int(element.sourceline or 0),
            )
        elif element.tag not in NEEDLESS_TAGS:
            self._left_out.setdefault(str(element.tag), []).append(int(element.sourceline or 0))
        return tags

    def _leave_out_plugin(self, element: Any) -> None:
        file = str(element.get("filename", "")).strip()
        name = f"{file} {element.get('name', '')}".lower()
        if any(part in name for part in NEEDLESS_PLUGINS):
            return
        instead = next((text for part, text in INSTEAD_OF_PLUGINS.items() if part in name), "")
        self._report.drop(
            f"<gazebo> <plugin filename='{file}'>",
            f"Gazebo's plugins are not loaded{instead}",
            int(element.sourceline or 0),
        )

    def _friction(self, element: Any) -> float | None:
        value = next(_numbers(_text(element)), math.nan)
        if not (math.isfinite(value) and value >= 0):
            self._doubt(element, "is no number from 0 on; it is left out")
            return None
        return min(max(value, SLIPPERIEST), ROUGHEST)

    def _color(self, element: Any) -> Color | None:
        if element.tag == "material" and _text(element):
            color = gazebo_color(_text(element))
            if color is None:
                self._doubt(element, "is no material of Gazebo's; the link keeps its colours")
            return color
        for tag in ("diffuse", "ambient"):
            found = element.find(f".//{tag}")
            numbers = [] if found is None else list(_numbers(_text(found)))
            if len(numbers) in (3, 4) and all(map(math.isfinite, numbers)):
                red, green, blue, alpha = (min(max(n, 0.0), 1.0) for n in [*numbers, 1.0][:4])
                return red, green, blue, alpha
        return None

    def _doubt(self, element: Any, problem: str) -> None:
        self._report.warn(
            f"<gazebo> <{element.tag}>",
            f"'{_text(element)}' {problem}",
            int(element.sourceline or 0),
        )


def _text(element: Any) -> str:
    return str(element.text or element.get("value") or "").strip()


def _numbers(text: str) -> Iterator[float]:
    for word in text.split():
        try:
            yield float(word)
        except ValueError:
            yield math.nan
