"""Reads the `<ros2_control>` blocks of a robot description."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import field

from arm_control.errors import HardwareInfoError
from arm_description.urdf.description import Description, RobotDescription, as_description
from arm_description.urdf.element import UrdfElement
from arm_description.urdf.robot import Mimic
from arm_description.urdf.xml_document import finite_number
from arm_node.frozen import frozen

COMPONENT_TYPES = ("system", "actuator", "sensor")


@frozen
class InterfaceInfo:
    """One command or state interface of a joint, sensor or GPIO, in rad or m and s.

    Attributes:
        name: without the joint, for example 'position'.
        initial_value: value at the start, None if not given or nan; 0 or 1 for a bool.
        minimum: lowest command, None if not given.
        maximum: highest command, None if not given.
        parameters: every `<param>` of the interface, including the ones above, as text.
        is_limited: whether its commands may be clamped; `<limits enable="false"/>` prevents it.
        data_type: type named in the description; every value is a float here.
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
        """Which of `min` and `max` are given but are not finite numbers; they are ignored."""
        read = {"min": self.minimum, "max": self.maximum}
        return tuple(
            key for key, value in read.items() if self.parameters.get(key) and value is None
        )


@frozen
class JointInfo:
    """A joint of a component; also used for sensors and GPIOs.

    Attributes:
        name: the joint's name.
        command_interfaces: in document order.
        state_interfaces: in document order.
        parameters: its `<param>`s, as text.
        mimic: from the URDF's joint of that name; None if it mimics no joint or the block has
            mimic="false".
        is_limited: whether its commands may be clamped; `<limits enable="false"/>` prevents it.
    """

    name: str
    command_interfaces: tuple[InterfaceInfo, ...] = ()
    state_interfaces: tuple[InterfaceInfo, ...] = ()
    parameters: Mapping[str, str] = field(default_factory=dict)
    mimic: Mimic | None = None
    is_limited: bool = True


@frozen
class HardwareInfo:
    """One `<ros2_control>` block.

    Attributes:
        name: the component's name.
        type: 'system', 'actuator' or 'sensor'.
        plugin: the driver's type string.
        joints: in document order.
        sensors: in document order; they have no command interfaces.
        gpios: in document order.
        parameters: the `<param>`s of `<hardware>`, as text.
        group: components of a group are configured together, then activated together; may be empty.
        read_write_rate_hz: how often to read and write it; 0 for the manager's rate.
        is_async: whether it asks for a separate thread.
        line: line of the description where the block starts.
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
        """Data types of all interfaces by full name, as the description gives them."""
        return {
            f"{part.name}/{interface.name}": interface.data_type
            for part in self._parts()
            for interface in (*part.state_interfaces, *part.command_interfaces)
        }

    def _parts(self) -> Iterator[JointInfo]:
        yield from self.joints
        yield from self.sensors
        yield from self.gpios


def parse_hardware_info(description: Description) -> tuple[HardwareInfo, ...]:
    """Return the `<ros2_control>` blocks of a robot description; empty if it has none.

    Raises:
        HardwareInfoError: a block is incomplete, repeats a name, or has a value that is not a
            number; the message names the component and the line.
        arm_description.errors.XmlError: the text is not XML.
    """
    return as_description(description).read(_parse_components)


def _parse_components(description: RobotDescription) -> tuple[HardwareInfo, ...]:
    components: dict[str, HardwareInfo] = {}
    mimics = _parse_mimics(description)
    for element in description.ros2_control:
        component = _parse_component(element, mimics)
        if component.name in components:
            raise HardwareInfoError(
                f"line {component.line}: a second <ros2_control> component is named "
                f"'{component.name}'; the first is in line {components[component.name].line}"
            )
        components[component.name] = component
    return tuple(components.values())


def _parse_mimics(description: RobotDescription) -> dict[str, Mimic]:
    """Return the `<mimic>` elements of the URDF's joints, by joint."""
    mimics: dict[str, Mimic] = {}
    for joint in description.joints:
        mimic = joint.first("mimic")
        if mimic is None:
            continue
        name = joint.attributes.get("name")
        line, where = mimic.line, f"<mimic> in <joint name='{name}'>"
        multiplier = _parse_number(mimic.attributes, "multiplier", line, where)
        mimics[name or ""] = Mimic(
            mimic.get("joint"),
            1.0 if multiplier is None else multiplier,
            _parse_number(mimic.attributes, "offset", line, where) or 0.0,
        )
    return mimics


def _parse_component(element: UrdfElement, mimics: Mapping[str, Mimic]) -> HardwareInfo:
    name = _required_name(element, "<ros2_control>")
    where = f"<ros2_control name='{name}'>"
    kind = element.get("type")
    if kind not in COMPONENT_TYPES:
        raise HardwareInfoError(
            f"line {element.line}: {where} has type '{kind}'; "
            f"it must be one of {', '.join(COMPONENT_TYPES)}"
        )
    hardware = element.first("hardware")
    plugin = _content(hardware, "plugin") if hardware else ""
    if hardware is None or not plugin:
        raise HardwareInfoError(
            f"line {element.line}: {where} has no <hardware><plugin>, so its driver is unknown"
        )
    return HardwareInfo(
        name=name,
        type=kind,
        plugin=plugin,
        joints=_parse_parts(element, "joint", where, mimics),
        sensors=_parse_parts(element, "sensor", where),
        gpios=_parse_parts(element, "gpio", where),
        parameters=_parse_parameters(hardware, where),
        group=_content(hardware, "group"),
        read_write_rate_hz=_parse_rate(element, where),
        is_async=element.text("is_async").lower() == "true",
        line=element.line,
    )


def _parse_rate(element: UrdfElement, where: str) -> int:
    text = element.text("rw_rate", "0")
    if not text.isdecimal():
        raise HardwareInfoError(
            f"line {element.line}: rw_rate of {where} is '{text}'; it must be a whole number "
            "of Hz, or 0 for the controller manager's rate"
        )
    return int(text)


def _parse_parts(
    element: UrdfElement,
    tag: str,
    where: str,
    mimics: Mapping[str, Mimic] | None = None,
) -> tuple[JointInfo, ...]:
    parts: list[JointInfo] = []
    for name, child in _named_children(element, tag, where):
        here = f"<{tag} name='{name}'> of {where}"
        parts.append(
            JointInfo(
                name=name,
                command_interfaces=_parse_interfaces(child, "command_interface", here),
                state_interfaces=_parse_interfaces(child, "state_interface", here),
                parameters=_parse_parameters(child, here),
                mimic=(mimics or {}).get(name) if _is_on(child, "mimic") else None,
                is_limited=_is_limited(child),
            )
        )
    return tuple(parts)


def _parse_interfaces(element: UrdfElement, tag: str, where: str) -> tuple[InterfaceInfo, ...]:
    interfaces: list[InterfaceInfo] = []
    for name, child in _named_children(element, tag, where):
        here = f"<{tag} name='{name}'> of {where}"
        parameters = _parse_parameters(child, here)
        data_type = child.get("data_type", "double")
        interfaces.append(
            InterfaceInfo(
                name=name,
                initial_value=_parse_initial_value(parameters, data_type, child.line, here),
                minimum=_parse_limit(parameters, "min"),
                maximum=_parse_limit(parameters, "max"),
                parameters=parameters,
                is_limited=_is_limited(child),
                data_type=data_type,
            )
        )
    return tuple(interfaces)


def _named_children(
    element: UrdfElement, tag: str, where: str
) -> Iterator[tuple[str, UrdfElement]]:
    """Yield the children with a tag and their names, which must be there and differ."""
    names: set[str] = set()
    for child in element.children(tag):
        name = _required_name(child, f"<{tag}> of {where}")
        if name in names:
            raise HardwareInfoError(
                f"line {child.line}: {where} has a second <{tag}> named '{name}'"
            )
        names.add(name)
        yield name, child


def _is_limited(element: UrdfElement) -> bool:
    limits = element.first("limits")
    return limits is None or _is_on(limits, "enable")


def _is_on(element: UrdfElement, attribute: str) -> bool:
    """Return whether an attribute is not 'false'; xacro may write it as Python's 'False'."""
    return element.text(attribute).lower() != "false"


def _parse_parameters(element: UrdfElement, where: str) -> dict[str, str]:
    return {
        _required_name(child, f"<param> of {where}"): child.content
        for child in element.children("param")
    }


def _parse_initial_value(
    parameters: Mapping[str, str], data_type: str, line: int | None, where: str
) -> float | None:
    """Return a number, 0 or 1 for a bool; None if it is missing or nan."""
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
    value = finite_number(text)
    if math.isnan(value):
        raise HardwareInfoError(
            f"line {line}: '{key}' of {where} is '{text}'; it must be a finite number"
        )
    return value


def _parse_limit(parameters: Mapping[str, str], key: str) -> float | None:
    """Return a number; None if the text is not one. ros2_control ignores such limits as well.

    Published descriptions, for example Universal Robots', contain "{2*pi}" here.
    """
    value = finite_number(parameters.get(key, ""))
    return None if math.isnan(value) else value


def _content(element: UrdfElement, tag: str) -> str:
    child = element.first(tag)
    return child.content if child else ""


def _required_name(element: UrdfElement, what: str) -> str:
    name = element.text("name")
    if not name:
        raise HardwareInfoError(f"line {element.line}: {what} has no name")
    return name
