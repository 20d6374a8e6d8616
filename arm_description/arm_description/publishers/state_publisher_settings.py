"""Checks the parameters of robot_state_publisher."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

from arm_description.errors import SettingsError
from arm_node.parameter_values import (
    NumberReader,
    ParameterValueError,
    Reader,
    Value,
    read_flag,
    read_parameter,
    read_text,
)

read_frequency = NumberReader("between 0 and 1000 Hz", 0.0, 1000.0)


@dataclass(frozen=True, slots=True)
class StatePublisherSettings:
    """The settings of robot_state_publisher.

    Attributes:
        robot_description: the URDF, not empty.
        publish_frequency_hz: maximum rate at which joint states are used; 0 for no limit.
        frame_prefix: prefix of every frame's name ("left/").
        ignore_timestamp: use every joint state, regardless of its stamp.
    """

    robot_description: str
    publish_frequency_hz: float = 20.0
    frame_prefix: str = ""
    ignore_timestamp: bool = False

    @staticmethod
    def from_parameters(values: Mapping[str, object]) -> "StatePublisherSettings":
        """Check the parameters' values, as YAML or a parameter service gives them.

        Raises:
            SettingsError: the description is empty, the frequency is outside 0 to 1000 Hz, or a
                type is wrong.
        """

        def value(name: str, default: object, read: Reader[Value]) -> Value:
            return read_parameter(name, values.get(name, default), read)

        description = values.get("robot_description", "")
        if not isinstance(description, str):
            raise SettingsError("robot_description must be a string: the URDF's text")
        if not description.strip():
            raise SettingsError(
                "Empty URDF is not allowed: set the parameter robot_description to the URDF's text"
            )
        try:
            return StatePublisherSettings(
                description,
                value("publish_frequency", 20.0, read_frequency),
                value("frame_prefix", "", partial(read_text, wanted="a string")),
                value("ignore_timestamp", False, read_flag),
            )
        except ParameterValueError as error:
            raise SettingsError(str(error)) from error
