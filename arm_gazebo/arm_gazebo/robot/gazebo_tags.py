"""Read the physics and colours of links from `<gazebo>` tags. Sensors are read elsewhere."""

import math
from collections.abc import Mapping
from dataclasses import field, replace

from arm_description.mesh.data import Color
from arm_description.urdf.description import Description, RobotDescription, as_description
from arm_description.urdf.element import UrdfElement
from arm_description.urdf.xml_document import finite_number
from arm_gazebo.build_report import BuildOutcome, BuildReport, Finding, as_one
from arm_node.frozen import frozen
from arm_node.names import listing

_PREFIX = "Gazebo/"
_RGB: dict[str, tuple[float, float, float]] = {
    "Black": (0.0, 0.0, 0.0),
    "Blue": (0.0, 0.0, 1.0),
    "DarkGray": (0.175, 0.175, 0.175),
    "DarkGrey": (0.175, 0.175, 0.175),
    "DarkYellow": (0.7, 0.7, 0.0),
    "FlatBlack": (0.1, 0.1, 0.1),
    "Gold": (0.8, 0.65, 0.12),
    "Gray": (0.7, 0.7, 0.7),
    "Green": (0.0, 1.0, 0.0),
    "Grey": (0.7, 0.7, 0.7),
    "Indigo": (0.33, 0.0, 0.5),
    "LightGray": (0.9, 0.9, 0.9),
    "LightGrey": (0.9, 0.9, 0.9),
    "Orange": (1.0, 0.51, 0.05),
    "Purple": (1.0, 0.0, 1.0),
    "Red": (1.0, 0.0, 0.0),
    "SkyBlue": (0.13, 0.44, 0.7),
    "Turquoise": (0.0, 1.0, 1.0),
    "White": (1.0, 1.0, 1.0),
    "Wood": (0.6, 0.45, 0.3),
    "Yellow": (1.0, 1.0, 0.0),
    "ZincYellow": (0.97, 0.95, 0.21),
}


def gazebo_color(name: str) -> Color | None:
    """Return the colour of a material such as "Gazebo/Orange"; None if it is unknown."""
    rgb = _RGB.get(name.removeprefix(_PREFIX))
    return None if rgb is None else (*rgb, 1.0)


MIN_FRICTION = 1e-5
MAX_FRICTION = 10.0
"""With it nothing slides on a slope of 84 degrees; more makes contacts hard to solve."""
FRICTION_TAGS = ("mu", "mu1", "mu2")
SELF_COLLIDE_TAGS = ("selfCollide", "self_collide")
GRAVITY_TAGS = ("gravity", "turnGravityOff")
IGNORED_TAGS = frozenset(
    {
        "sensor",  # read by `arm_gazebo.sensors`
        "preserveFixedJoint",  # every frame is kept
        "disableFixedJointLumping",
        "disableJointLumping",
        "implicitSpringDamper",  # damping is always implicit
        "cfmDamping",
        "provideFeedback",
        "provide_feedback",
    }
)
IGNORED_PLUGINS = (
    "ros2_control",  # the hardware in <ros2_control> needs no plugin
    "ros_control",
    "mimic",  # mimic joints need no plugin
    "sensors",  # sensors need no plugin
    "-imu-",
    "forcetorque",
    "-contact-",
    "joint-state-publisher",  # joint_state_broadcaster does this
    "joint_state_publisher",
)
"""Parts of the names of Gazebo plugins that are not needed here."""
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


@frozen
class LinkTags:
    """The tags of one link.

    Attributes:
        friction: friction coefficient of its collisions, None if not given.
        friction_along: coefficient in the direction of `grip`; None if not given.
        grip: <fdir1>, the first direction of friction; None if not given.
        grip_frame: the link in whose axes `grip` is given; empty for this one.
        self_collide: whether it collides with other links of the robot.
        rgba: colour of all its visuals, None if not given.
        weightless: whether gravity does not act on it.
    """

    friction: float | None = None
    friction_along: float | None = None
    grip: tuple[float, float, float] | None = None
    grip_frame: str = ""
    self_collide: bool = False
    rgba: Color | None = None
    weightless: bool = False


NO_LINK_TAGS = LinkTags()


@frozen
class GazeboTags:
    """The tags of a robot.

    Attributes:
        links: the links that have tags, by name.
        self_collide: whether all links collide with each other.
        findings: what is invalid or cannot be simulated.
    """

    links: Mapping[str, LinkTags] = field(default_factory=dict)
    self_collide: bool = False
    findings: tuple[Finding, ...] = ()

    def link(self, name: str) -> LinkTags:
        """Return the tags of a link."""
        return self.links.get(name, NO_LINK_TAGS)

    @property
    def weightless(self) -> frozenset[str]:
        """The links on which gravity does not act."""
        return frozenset(name for name, tags in self.links.items() if tags.weightless)


def parse_gazebo_tags(description: Description) -> GazeboTags:
    """Return the content of a description's <gazebo> elements; invalid values become findings.

    Raises:
        XmlError: the text is not XML.
    """
    return as_description(description).read(_read_tags)


def _read_tags(description: RobotDescription) -> GazeboTags:
    parts = (*description.links, *description.joints)
    reader = _TagReader({part.get("name") for part in parts})
    for gazebo in description.gazebo:
        reader.read(gazebo)
    return reader.tags()


class _TagReader:
    """Collects the tags of one description."""

    def __init__(self, names: set[str]) -> None:
        self._names = names
        self._links: dict[str, LinkTags] = {}
        self._self_collide = False
        self._report = BuildReport()
        self._left_out: dict[str, list[Finding]] = {}

    def tags(self) -> GazeboTags:
        self._report.add(*map(as_one, self._left_out.values()))
        return GazeboTags(self._links, self._self_collide, self._report.findings)

    def read(self, gazebo: UrdfElement) -> None:
        reference = gazebo.text("reference")
        if reference and reference not in self._names:
            self._report.warn(
                f"<gazebo reference='{reference}'>",
                f"no link or joint has this name; there are {listing(sorted(self._names))}",
                gazebo.line,
            )
            return
        before = self._links.get(reference, NO_LINK_TAGS)
        after = before
        for element in gazebo.elements:
            after = self._take(after, element, reference)
        if reference and after != before:
            self._links[reference] = after

    def _take(self, tags: LinkTags, element: UrdfElement, reference: str) -> LinkTags:
        if element.tag in FRICTION_TAGS and reference:
            friction = self._friction(element)
            known = tags.friction
            # MuJoCo has one coefficient for both directions; the lower one is the safe choice.
            lowest = friction if known is None or friction is None else min(known, friction)
            along = tags.friction_along if element.tag == "mu2" else friction
            return replace(tags, friction=known if lowest is None else lowest, friction_along=along)
        if element.tag == "fdir1" and reference:
            return self._grip(tags, element)
        if element.tag in SELF_COLLIDE_TAGS:
            wanted = _is_true(element)
            self._self_collide |= wanted and not reference
            return replace(tags, self_collide=wanted)
        if element.tag in GRAVITY_TAGS and reference:
            return replace(tags, weightless=_is_true(element) != (element.tag == "gravity"))
        if element.tag == "material" or (element.tag == "visual" and reference):
            return replace(tags, rgba=self._color(element) or tags.rgba)
        if element.tag == "plugin":
            self._leave_out_plugin(element)
        elif element.tag == "sensor" and not reference:
            self._report.drop(
                f"<gazebo> <sensor name='{element.attributes.get('name')}'>",
                "no link carries it: its <gazebo> has no reference",
                element.line,
            )
        elif element.tag not in IGNORED_TAGS:
            name, reason = element.tag, REASONS.get(element.tag, "it is not simulated")
            finding = Finding(BuildOutcome.DROPPED, f"<gazebo> <{name}>", reason, element.line)
            self._left_out.setdefault(name, []).append(finding)
        return tags

    def _leave_out_plugin(self, element: UrdfElement) -> None:
        file = element.text("filename")
        name = f"{file} {element.get('name')}".lower()
        if any(part in name for part in IGNORED_PLUGINS):
            return
        instead = next((text for part, text in INSTEAD_OF_PLUGINS.items() if part in name), "")
        self._report.drop(
            f"<gazebo> <plugin filename='{file}'>",
            f"Gazebo's plugins are not loaded{instead}",
            element.line,
        )

    def _friction(self, element: UrdfElement) -> float | None:
        value = next(iter(_numbers(_text(element))), math.nan)
        if not value >= 0:
            self._warn(element, "is not a number of at least 0; it is left out")
            return None
        return min(max(value, MIN_FRICTION), MAX_FRICTION)

    def _grip(self, tags: LinkTags, element: UrdfElement) -> LinkTags:
        direction = _numbers(_text(element))
        if len(direction) != 3 or any(map(math.isnan, direction)) or not any(direction):
            self._warn(element, "is not a direction x y z; it is left out")
            return tags
        frames = [
            value for key, value in element.attributes.items() if key.endswith("expressed_in")
        ]
        if frames and frames[0] not in self._names:
            self._warn(element, f"is given in '{frames[0]}', which is not a link; it is left out")
            return tags
        x, y, z = direction
        return replace(tags, grip=(x, y, z), grip_frame=frames[0] if frames else "")

    def _color(self, element: UrdfElement) -> Color | None:
        if element.tag == "material" and _text(element):
            color = gazebo_color(_text(element))
            if color is None:
                self._warn(element, "is not a material of Gazebo's; the link keeps its colours")
            return color
        for tag in ("diffuse", "ambient"):
            found = next((inner for inner in element.inside() if inner.tag == tag), None)
            numbers = _numbers(_text(found)) if found else []
            if len(numbers) in (3, 4) and not any(map(math.isnan, numbers)):
                red, green, blue, alpha = (min(max(n, 0.0), 1.0) for n in [*numbers, 1.0][:4])
                return red, green, blue, alpha
        return None

    def _warn(self, element: UrdfElement, problem: str) -> None:
        self._report.warn(
            f"<gazebo> <{element.tag}>",
            f"'{_text(element)}' {problem}",
            element.line,
        )


def _text(element: UrdfElement) -> str:
    return element.content or element.text("value")


def _is_true(element: UrdfElement) -> bool:
    return _text(element).lower() in ("true", "1")


def _numbers(text: str) -> list[float]:
    """Return the numbers of a text; nan for a word that is no finite number."""
    return [finite_number(word) for word in text.split()]
