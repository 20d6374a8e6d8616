"""The parameters of robot_state_publisher, checked."""

from collections.abc import Mapping
from dataclasses import dataclass

from arm_description.errors import SettingsError

HIGHEST_FREQUENCY_HZ = 1000.0


@dataclass(frozen=True, slots=True)
class StatePublisherSettings:
    """What robot_state_publisher is to do.

    Attributes:
        robot_description: the URDF, not empty.
        publish_frequency_hz: joint states are passed on at most so often; 0: all of them.
        frame_prefix: put before every frame's name as it stands ("left/").
        ignore_timestamp: pass on every joint state, whatever its stamp.
    """

    robot_description: str
    publish_frequency_hz: float = 20.0
    frame_prefix: str = ""
    ignore_timestamp: bool = False

    @staticmethod
    def from_parameters(values: Mapping[str, object]) -> "StatePublisherSettings":
        """Check the parameters' values, as YAML or a parameter service gives them.

        Raises:
            SettingsError: an empty description, a frequency outside 0 to 1000 Hz, a wrong type.
        """
        description = values.get("robot_description", "")
        if not isinstance(description, str):
            raise SettingsError("robot_description must be a string: the URDF's text")
        if not description.strip():
            raise SettingsError(
                "Empty URDF is not allowed: give the parameter robot_description the URDF's text"
            )
        frequency = values.get("publish_frequency", 20.0)
        if isinstance(frequency, bool) or not isinstance(frequency, int | float):
            raise SettingsError(f"publish_frequency must be a number, not {frequency!r}")
        if not 0.0 <= frequency <= HIGHEST_FREQUENCY_HZ:
            raise SettingsError(
                f"publish_frequency must be between 0 and 1000 Hz, not {frequency:g}"
            )
        prefix = values.get("frame_prefix", "")
        if not isinstance(prefix, str):
            raise SettingsError(f"frame_prefix must be a string, not {prefix!r}")
        ignore = values.get("ignore_timestamp", False)
        if not isinstance(ignore, bool):
            raise SettingsError(f"ignore_timestamp must be true or false, not {ignore!r}")
        return StatePublisherSettings(description, float(frequency), prefix, ignore)
