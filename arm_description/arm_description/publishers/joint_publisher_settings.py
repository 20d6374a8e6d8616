"""Checks the parameters of joint_state_publisher."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from arm_description.errors import SettingsError
from arm_description.urdf.mimic import Mimic
from arm_node.parameter_values import (
    IntegerReader,
    ParameterValueError,
    Reader,
    Value,
    read_flag,
    read_number,
    read_parameter,
    read_text,
    read_texts,
)

ZEROS = "zeros."
DEPENDENT_JOINTS = "dependent_joints."
"""Prefixes of the parameters that are named after joints."""


@dataclass(frozen=True, slots=True)
class JointPublisherSettings:
    """The settings of joint_state_publisher.

    Attributes:
        rate_hz: messages per second.
        source_list: topics whose joint states are merged.
        publish_default_positions: joints without a source have a position from the start;
            likewise velocities and efforts, which are 0.
        use_mimic_tags: joints with <mimic> in the URDF are dependent.
        use_smallest_joint_limits: soft limits narrow the range.
        delta: step of every joint (rad or m) in each message, back and forth; 0 for no motion.
        zeros: initial position by joint name, if it is not 0 or the middle of the range.
        dependent_joints: mimic rules by joint name, in addition to the URDF's <mimic>.
    """

    rate_hz: int = 10
    source_list: tuple[str, ...] = ()
    publish_default_positions: bool = True
    publish_default_velocities: bool = False
    publish_default_efforts: bool = False
    use_mimic_tags: bool = True
    use_smallest_joint_limits: bool = True
    delta: float = 0.0
    zeros: Mapping[str, float] = field(default_factory=dict)
    dependent_joints: Mapping[str, Mimic] = field(default_factory=dict)

    @staticmethod
    def from_parameters(parameters: Mapping[str, Any]) -> "JointPublisherSettings":
        """Check the parameters' values; other names are ignored.

        Raises:
            SettingsError: a value has the wrong type, the rate is below 1, a number is not finite,
                or a dependent joint has no parent or an unknown key.
        """
        values = {
            name: _checked(name, parameters.get(name, default), read)
            for name, (default, read, _) in PARAMETERS.items()
        }
        return JointPublisherSettings(
            rate_hz=values.pop("rate"),
            zeros={
                name.removeprefix(ZEROS): _checked(name, value, read_number)
                for name, value in parameters.items()
                if name.startswith(ZEROS)
            },
            dependent_joints=_dependences(parameters),
            **values,
        )


def _checked(name: str, value: object, read: Reader[Value]) -> Value:
    try:
        return read_parameter(name, value, read)
    except ParameterValueError as error:
        raise SettingsError(str(error)) from error


def _dependences(parameters: Mapping[str, Any]) -> dict[str, Mimic]:
    found: dict[str, dict[str, Any]] = {}
    for name, value in parameters.items():
        if name.startswith(DEPENDENT_JOINTS):
            # A joint's name may contain dots; the last part is the key.
            joint, _, key = name.removeprefix(DEPENDENT_JOINTS).rpartition(".")
            if key not in ("parent", "factor", "offset") or not joint:
                raise SettingsError(
                    f"parameter {name}: a dependent joint has parent, factor and offset"
                )
            found.setdefault(joint, {})[key] = value
    return {joint: _dependence(joint, keys) for joint, keys in found.items()}


def named_after_joints(given: Iterable[str]) -> dict[str, tuple[Any, Reader[Any], str]]:
    """Return those of the given parameters that are named after joints, as in `PARAMETERS`.

    Args:
        given: names of parameters that `JointPublisherSettings.from_parameters` accepts.
    """
    found: dict[str, tuple[Any, Reader[Any], str]] = {}
    for name in given:
        if name.startswith(ZEROS):
            found[name] = (0.0, read_number, "initial position of the joint (rad or m)")
        elif name.startswith(DEPENDENT_JOINTS):
            found[name] = _OF_A_DEPENDENT_JOINT[name.rpartition(".")[2]]
    return found


def _dependence(joint: str, keys: Mapping[str, Any]) -> Mimic:
    name = f"{DEPENDENT_JOINTS}{joint}"
    parent = keys.get("parent")
    if not isinstance(parent, str) or not parent:
        raise SettingsError(f"{name}.parent must name a joint, not {parent!r}")
    return Mimic(
        parent,
        _checked(f"{name}.factor", keys.get("factor", 1.0), read_number),
        _checked(f"{name}.offset", keys.get("offset", 0.0), read_number),
    )


_OF_A_DEPENDENT_JOINT: dict[str, tuple[Any, Reader[Any], str]] = {
    "parent": ("", read_text, "joint that the dependent joint follows"),
    "factor": (1.0, read_number, "ratio of its position to that of the parent"),
    "offset": (0.0, read_number, "position when that of the parent is 0 (rad or m)"),
}

PARAMETERS: dict[str, tuple[Any, Reader[Any], str]] = {
    "rate": (
        10,
        IntegerReader("an integer from 1 to 10000 (Hz)", 1, 10_000),
        "messages per second",
    ),
    "source_list": (
        [],
        partial(read_texts, wanted="a list of topics"),
        "topics whose joint states are merged",
    ),
    "publish_default_positions": (
        True,
        read_flag,
        "whether joints without a source have a position from the start",
    ),
    "publish_default_velocities": (False, read_flag, "whether they have the velocity 0 as well"),
    "publish_default_efforts": (False, read_flag, "whether they have the effort 0 as well"),
    "use_mimic_tags": (True, read_flag, "whether joints with <mimic> follow their leaders"),
    "use_smallest_joint_limits": (
        True,
        read_flag,
        "whether soft limits narrow the range of a joint",
    ),
    "delta": (
        0.0,
        read_number,
        "distance that each joint moves per message, back and forth (rad or m); 0 for no motion",
    ),
}
"""The parameters with names of their own: default, reader and description."""
