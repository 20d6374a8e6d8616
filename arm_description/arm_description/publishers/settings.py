"""The settings of robot_state_publisher and joint_state_publisher; see `arm_node.setting`."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from arm_description.errors import SettingsError
from arm_description.urdf.robot import Mimic
from arm_node.parameter_values import (
    IntegerReader,
    NumberReader,
    ParameterValueError,
    read_nonempty_text,
    read_parameter,
    read_texts,
)
from arm_node.setting import Setting, given_values, read_settings, setting, settings_of

_ZEROS, _DEPENDENT_JOINTS = "zeros.", "dependent_joints."
"""Prefixes of the parameters that are named after joints."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StatePublisherSettings:
    """The settings of robot_state_publisher."""

    robot_description: str = setting("", "the robot's URDF", changes=True)
    publish_frequency_hz: float = setting(
        20.0,
        "highest frequency of /tf in Hz; 0 for no limit",
        NumberReader("between 0 and 1000 Hz", 0.0, 1000.0),
        name="publish_frequency",
        changes=True,
    )
    frame_prefix: str = setting(
        "", "prefix of the name of every frame, such as left/", changes=True
    )
    ignore_timestamp: bool = setting(
        False, "whether joint states with old stamps are published as well", changes=True
    )

    @staticmethod
    def from_parameters(values: Mapping[str, object]) -> "StatePublisherSettings":
        """Check the parameters' values, as YAML or a parameter service gives them.

        Raises:
            SettingsError: the description is empty, the frequency is outside 0 to 1000 Hz, or a
                type is wrong.
        """
        with _settings_errors():
            settings = read_settings(StatePublisherSettings, given_values(values))
        if not settings.robot_description.strip():
            raise SettingsError(
                "Empty URDF is not allowed: set the parameter robot_description to the URDF's text"
            )
        return settings


@dataclass(frozen=True, slots=True, kw_only=True)
class JointPublisherSettings:
    """The settings of joint_state_publisher.

    Attributes:
        zeros: initial position by joint name, if it is not 0 or the middle of the range.
        dependent_joints: mimic rules by joint name, in addition to the URDF's <mimic>.
    """

    rate_hz: int = setting(
        10,
        "messages per second",
        IntegerReader("an integer from 1 to 10000 (Hz)", 1, 10_000),
        name="rate",
        changes=True,
    )
    source_list: tuple[str, ...] = setting(
        (), "topics whose joint states are merged", partial(read_texts, wanted="a list of topics")
    )
    publish_default_positions: bool = setting(
        True, "whether joints without a source have a position from the start"
    )
    publish_default_velocities: bool = setting(False, "whether they have the velocity 0 as well")
    publish_default_efforts: bool = setting(False, "whether they have the effort 0 as well")
    use_mimic_tags: bool = setting(True, "whether joints with <mimic> follow their leaders")
    use_smallest_joint_limits: bool = setting(
        True, "whether soft limits narrow the range of a joint"
    )
    delta: float = setting(
        0.0,
        "distance that each joint moves per message, back and forth (rad or m); 0 for no motion",
        changes=True,
    )
    zeros: Mapping[str, float] = field(default_factory=dict[str, float])
    dependent_joints: Mapping[str, Mimic] = field(default_factory=dict[str, Mimic])

    @staticmethod
    def from_parameters(values: Mapping[str, Any]) -> "JointPublisherSettings":
        """Check the parameters' values; other names are ignored.

        Raises:
            SettingsError: a value has the wrong type, the rate is below 1, a number is not finite,
                or a dependent joint has no parent or an unknown key.
        """
        source = given_values(values)
        (zero,) = settings_of(_Zero)
        dependent = {_dependent(name) for name in values if name.startswith(_DEPENDENT_JOINTS)}
        with _settings_errors():
            return read_settings(
                JointPublisherSettings,
                source,
                zeros={
                    name.removeprefix(_ZEROS): read_parameter(name, value, zero.read)
                    for name, value in values.items()
                    if name.startswith(_ZEROS)
                },
                dependent_joints={
                    joint: read_settings(_Dependence, source, f"{_DEPENDENT_JOINTS}{joint}.").rule()
                    for joint in dependent
                },
            )

    @staticmethod
    def declarations(given: Mapping[str, Any]) -> Iterator[Setting]:
        """Yield the settings, and those that given parameters make by naming joints."""
        yield from settings_of(JointPublisherSettings)
        (zero,) = settings_of(_Zero)
        of_a_dependence = {each.name: each for each in settings_of(_Dependence)}
        for name in given:
            if name.startswith(_ZEROS):
                yield replace(zero, name=name)
            elif name.startswith(_DEPENDENT_JOINTS):
                yield replace(of_a_dependence[name.rpartition(".")[2]], name=name)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Zero:
    position: float = setting(0.0, "initial position of the joint (rad or m)")


@dataclass(frozen=True, slots=True, kw_only=True)
class _Dependence:
    parent: str = setting(
        "",
        "joint that the dependent joint follows",
        partial(read_nonempty_text, wanted="the name of a joint"),
    )
    factor: float = setting(1.0, "ratio of its position to that of the parent")
    offset: float = setting(0.0, "position when that of the parent is 0 (rad or m)")

    def rule(self) -> Mimic:
        return Mimic(self.parent, self.factor, self.offset)


def _dependent(name: str) -> str:
    """Return the dependent joint that a parameter is about.

    A joint's name may contain dots; the last part is the key.
    """
    joint, _, key = name.removeprefix(_DEPENDENT_JOINTS).rpartition(".")
    if not joint or key not in {each.name for each in settings_of(_Dependence)}:
        raise SettingsError(f"parameter {name}: a dependent joint has parent, factor and offset")
    return joint


@contextmanager
def _settings_errors() -> Iterator[None]:
    try:
        yield
    except ParameterValueError as error:
        raise SettingsError(str(error)) from error
