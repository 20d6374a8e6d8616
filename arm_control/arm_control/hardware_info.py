"""What a robot description says about its hardware: the `<ros2_control>` blocks."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from arm_control.errors import HardwareInfoError
from arm_description.xml_document import parse_xml

if TYPE_CHECKING:
    import lxml.etree as etree

COMPONENT_TYPES = ("system", "actuator", "sensor")


@dataclass(frozen=True, slots=True)
class InterfaceInfo:
    """One command or state interface of a joint, sensor or GPIO, in rad or m and s.

    Attributes:
        name: without the joint, for example 'position'.
        initial_value: value at the start, None if not given or nan; a bool's is 0 or 1.
        minimum: lowest command, None if not given.
        maximum: highest command, None if not given.
        parameters: every `<param>` of the interface, the ones above included, as text.
        is_limited: whether its commands may be clamped; not after `<limits enable="false"/>`.
        data_type: what the description says that it is; all are numbers here.
    """

    name: str
    initial_value: float | None = None
    minimum: float | None = None
    maximum: float | None = None
    parameters: Mapping[str, str] = field(default_factory=dict)
    is_limited: bool = True
    data_type: str = "double"

    @property
    def unread_limits(self) -> tuple[str, ...]:
        """Which of `min` and `max` are given, but are no numbers: those do not count."""
        read = {"min": self.minimum, "max": self.maximum}
        return tuple(
            key for key, value in read.items() if self.parameters.get(key) and value is None
        )


@dataclass(frozen=True, slots=True)
class MimicInfo:
    """What a joint follows: its position is multiplier * leader + offset, in rad or m."""

    leader: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class JointInfo:
    """A joint of a component; sensors and GPIOs have the same shape.

    Attributes:
        name: of the joint.
        command_interfaces: in document order.
        state_interfaces: in document order.
        parameters: its `<param>`s, as text.
        mimic: from the URDF's joint of that name; None where it follows no other, or where
            mimic="false" says so.
        is_limited: whether its commands may be clamped; not after `<limits enable="false"/>`.
    """

    name: str
    command_interfaces: tuple[InterfaceInfo, ...] = ()
    state_interfaces: tuple[InterfaceInfo, ...] = ()
    parameters: Mapping[str, str] = field(default_factory=dict)
    mimic: MimicInfo | None = None
    is_limited: bool = True


@dataclass(frozen=True, slots=True)
class HardwareInfo:
    """One `<ros2_control>` block.

    Attributes:
        name: of the component.
        type: 'system', 'actuator' or 'sensor'.
        plugin: the driver's type string.
        joints: in document order.
        sensors: in document order; they have no command interfaces.
        gpios: in document order.
        parameters: the `<param>`s of `<hardware>`, as text.
        group: components of one group are configured, then activated, together; empty for none.
        read_write_rate_hz: how often to read and write it; 0 for the manager's rate.
        is_async: whether it wants a thread of its own.
        line: where the block starts in the description.
    """

    name: str
    type: str
    plugin: str
    joints: tuple[JointInfo, ...] = ()
    sensors: tuple[JointInfo, ...] = ()
    gpios: tuple[JointInfo, ...] = ()
    parameters: Mapping[str, str] = field(default_factory=dict)
    group: str = ""
    read_write_rate_hz: int = 0
    is_async: bool = False
    line: int = 0

    @property
    def state_interface_names(self) -> tuple[str, ...]:
        """Full names of all state interfaces: joints, sensors, GPIOs, each in document order."""
        return tuple(
            f"{part.name}/{interface.name}"
            for part in self._parts()
            for interface in part.state_interfaces
        )

    @property
    def command_interface_names(self) -> tuple[str, ...]:
        """Full names of all command interfaces: joints, sensors, GPIOs, each in document order."""
        return tuple(
            f"{part.name}/{interface.name}"
            for part in self._parts()
            for interface in part.command_interfaces
        )

    @property
    def data_types(self) -> dict[str, str]:
        """Data types of all interfaces by full name, as the description says them."""
        return {
            f"{part.name}/{interface.name}": interface.data_type
            for part in self._parts()
            for interface in (*part.state_interfaces, *part.command_interfaces)
        }

    def _parts(self) -> Iterator[JointInfo]:
        yield from self.joints
        yield from self.sensors
        yield from self.gpios


def parse_hardware_info(urdf_xml: str) -> tuple[HardwareInfo, ...]:
    """Return the `<ros2_control>` blocks of a robot description; empty where it has none.

    Raises:
        HardwareInfoError: a block lacks something, repeats a name, or has a value that is no
            number; the message names the component and the line.
        arm_description.errors.XmlError: the text is not XML.
    """
    components: dict[str, HardwareInfo] = {}
    robot = parse_xml(urdf_xml)
    mimics = _parse_mimics(robot)
    for element in robot.iterchildren("ros2_control"):
        component = _parse_component(element, mimics)
        if component.name in components:
            raise HardwareInfoError(
                f"line {component.line}: a second <ros2_control> component is named "
                f"'{component.name}'; the first stands in line {components[component.name].line}"
            )
        components[component.name] = component
    return tuple(components.values())


def _parse_mimics(robot: "etree._Element") -> dict[str, MimicInfo]:
    """Return what the URDF's joints say they follow, by joint."""
    mimics: dict[str, MimicInfo] = {}
    for joint in robot.iterchildren("joint"):
        mimic = joint.find("mimic")
        if mimic is None:
            continue
        line, where = mimic.sourceline, f"<mimic> in <joint name='{joint.get('name')}'>"
        numbers = dict(mimic.attrib)
        multiplier = _parse_number(numbers, "multiplier", line, where)
        mimics[joint.get("name") or ""] = MimicInfo(
            mimic.get("joint") or "",
            1.0 if multiplier is None else multiplier,
            _parse_number(numbers, "offset", line, where) or 0.0,
        )
    return mimics


def _parse_component(element: "etree._Element", mimics: Mapping[str, MimicInfo]) -> HardwareInfo:
    name = _required_name(element, "<ros2_control>")
    where = f"<ros2_control name='{name}'>"
    kind = element.get("type", "")
    if kind not in COMPONENT_TYPES:
        raise HardwareInfoError(
            f"line {element.sourceline}: {where} has type '{kind}'; "
            f"it must be one of {', '.join(COMPONENT_TYPES)}"
        )
    hardware = element.find("hardware")
    plugin = (hardware.findtext("plugin") or "").strip() if hardware is not None else ""
    if hardware is None or not plugin:
        raise HardwareInfoError(
            f"line {element.sourceline}: {where} names no <hardware><plugin>, "
            "so nothing says what drives it"
        )
    return HardwareInfo(
        name=name,
        type=kind,
        plugin=plugin,
        joints=_parse_parts(element, "joint", where, mimics),
        sensors=_parse_parts(element, "sensor", where),
        gpios=_parse_parts(element, "gpio", where),
        parameters=_parse_parameters(hardware, where),
        group=(hardware.findtext("group") or "").strip(),
        read_write_rate_hz=_parse_rate(element, where),
        is_async=element.get("is_async", "false").strip().lower() == "true",
        line=element.sourceline or 0,
    )


def _parse_rate(element: "etree._Element", where: str) -> int:
    text = element.get("rw_rate", "0").strip()
    if not text.isdecimal():
        raise HardwareInfoError(
            f"line {element.sourceline}: rw_rate of {where} is '{text}'; it must be a whole number "
            "of Hz, or 0 for the controller manager's rate"
        )
    return int(text)


def _parse_parts(
    element: "etree._Element",
    tag: str,
    where: str,
    mimics: Mapping[str, MimicInfo] | None = None,
) -> tuple[JointInfo, ...]:
    parts: dict[str, JointInfo] = {}
    for child in element.iterchildren(tag):
        name = _required_name(child, f"<{tag}> of {where}")
        if name in parts:
            raise HardwareInfoError(
                f"line {child.sourceline}: {where} has a second <{tag}> named '{name}'"
            )
        here = f"<{tag} name='{name}'> of {where}"
        parts[name] = JointInfo(
            name=name,
            command_interfaces=_parse_interfaces(child, "command_interface", here),
            state_interfaces=_parse_interfaces(child, "state_interface", here),
            parameters=_parse_parameters(child, here),
            mimic=(mimics or {}).get(name) if _is_on(child, "mimic") else None,
            is_limited=_is_limited(child),
        )
    return tuple(parts.values())


def _parse_interfaces(element: "etree._Element", tag: str, where: str) -> tuple[InterfaceInfo, ...]:
    interfaces: dict[str, InterfaceInfo] = {}
    for child in element.iterchildren(tag):
        name = _required_name(child, f"<{tag}> of {where}")
        if name in interfaces:
            raise HardwareInfoError(
                f"line {child.sourceline}: {where} has a second <{tag}> named '{name}'"
            )
        here = f"<{tag} name='{name}'> of {where}"
        parameters = _parse_parameters(child, here)
        data_type = child.get("data_type", "double")
        interfaces[name] = InterfaceInfo(
            name=name,
            initial_value=_parse_initial_value(parameters, data_type, child.sourceline, here),
            minimum=_parse_limit(parameters, "min"),
            maximum=_parse_limit(parameters, "max"),
            parameters=parameters,
            is_limited=_is_limited(child),
            data_type=data_type,
        )
    return tuple(interfaces.values())


def _is_limited(element: "etree._Element") -> bool:
    limits = element.find("limits")
    return limits is None or _is_on(limits, "enable")


def _is_on(element: "etree._Element", attribute: str) -> bool:
    """Return whether an attribute is anything but false; xacro writes Python's False."""
    return element.get(attribute, "").strip().lower() != "false"


def _parse_parameters(element: "etree._Element", where: str) -> dict[str, str]:
    return {
        _required_name(child, f"<param> of {where}"): (child.text or "").strip()
        for child in element.iterchildren("param")
    }


def _parse_initial_value(
    parameters: Mapping[str, str], data_type: str, line: int | None, where: str
) -> float | None:
    """Return a number, also for true and false of a bool; None where nan says there is none."""
    text = parameters.get("initial_value", "").lower()
    if text == "nan":
        return None
    if data_type == "bool" and text in ("true", "false"):
        return float(text == "true")
    return _parse_number(parameters, "initial_value", line, where)


def _parse_number(
    parameters: Mapping[str, str], key: str, line: int | None, where: str
) -> float | None:
    text = parameters.get(key)
    if not text:
        return None
    value = _number(text)
    if value is None:
        raise HardwareInfoError(
            f"line {line}: '{key}' of {where} is '{text}'; it must be a finite number"
        )
    return value


def _parse_limit(parameters: Mapping[str, str], key: str) -> float | None:
    """Return a number, None where there is none: as in ros2_control, others are passed over.

    Descriptions in use, those of Universal Robots among them, have "{2*pi}" there.
    """
    return _number(parameters.get(key, ""))


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _required_name(element: "etree._Element", what: str) -> str:
    name = (element.get("name") or "").strip()
    if not name:
        raise HardwareInfoError(f"line {element.sourceline}: {what} has no name")
    return name
