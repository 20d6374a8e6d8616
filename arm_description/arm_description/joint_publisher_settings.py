"""The parameters of joint_state_publisher, checked."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from arm_description.errors import SettingsError

DEFAULTS: dict[str, Any] = {
    "rate": 10,
    "source_list": [],
    "publish_default_positions": True,
    "publish_default_velocities": False,
    "publish_default_efforts": False,
    "use_mimic_tags": True,
    "use_smallest_joint_limits": True,
    "delta": 0.0,
}
"""The parameters with names of their own, and their defaults."""

ZEROS = "zeros."
DEPENDENT_JOINTS = "dependent_joints."
"""Prefixes of the parameters that are named after joints."""


@dataclass(frozen=True, slots=True)
class Dependence:
    """Position = factor x position of joint `parent` + offset."""

    parent: str
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class JointPublisherSettings:
    """What joint_state_publisher is to do.

    Attributes:
        rate_hz: publications a second.
        source_list: topics whose joint states are merged.
        publish_default_positions: joints without a source have a position from the start;
            likewise velocities and efforts, which are 0.
        use_mimic_tags: the URDF's <mimic> makes joints dependent.
        use_smallest_joint_limits: soft limits narrow the range.
        delta: every joint moves by so much (rad or m) at each publication, to and fro; 0: rests.
        zeros: position by joint name where it is not the middle or 0.
        dependent_joints: dependence by joint name.
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
    dependent_joints: Mapping[str, Dependence] = field(default_factory=dict)

    @staticmethod
    def from_parameters(parameters: Mapping[str, Any]) -> "JointPublisherSettings":
        """Check the parameters' values; names of others are passed over.

        Raises:
            SettingsError: a value of the wrong type, a rate below 1, a number that is not
                finite, a dependent joint without a parent or with an unknown key.
        """
        values = {**DEFAULTS, **parameters}
        return JointPublisherSettings(
            rate_hz=_rate(values["rate"]),
            source_list=_topics(values["source_list"]),
            delta=_number("delta", values["delta"]),
            zeros={
                name.removeprefix(ZEROS): _number(name, value)
                for name, value in parameters.items()
                if name.startswith(ZEROS)
            },
            dependent_joints=_dependences(parameters),
            **{name: _flag(name, values[name]) for name in _FLAGS},
        )


_FLAGS = [name for name, default in DEFAULTS.items() if isinstance(default, bool)]


def _dependences(parameters: Mapping[str, Any]) -> dict[str, Dependence]:
    found: dict[str, dict[str, Any]] = {}
    for name, value in parameters.items():
        if name.startswith(DEPENDENT_JOINTS):
            # A joint's name may hold dots, the last part is the key.
            joint, _, key = name.removeprefix(DEPENDENT_JOINTS).rpartition(".")
            if key not in ("parent", "factor", "offset") or not joint:
                raise SettingsError(
                    f"parameter {name}: a dependent joint has parent, factor and offset"
                )
            found.setdefault(joint, {})[key] = value
    return {joint: _dependence(joint, keys) for joint, keys in found.items()}


def _dependence(joint: str, keys: Mapping[str, Any]) -> Dependence:
    name = f"{DEPENDENT_JOINTS}{joint}"
    parent = keys.get("parent")
    if not isinstance(parent, str) or not parent:
        raise SettingsError(f"{name}.parent must name a joint, not {parent!r}")
    return Dependence(
        parent,
        _number(f"{name}.factor", keys.get("factor", 1.0)),
        _number(f"{name}.offset", keys.get("offset", 0.0)),
    )


def _rate(value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= 10_000:
        raise SettingsError(f"rate must be an integer from 1 to 10000 (Hz), not {value!r}")
    return value


def _topics(value: object) -> tuple[str, ...]:
    # An empty list in a YAML file arrives as no value at all.
    if value is None:
        return ()
    if not isinstance(value, list | tuple) or not all(isinstance(x, str) and x for x in value):
        raise SettingsError(f"source_list must be a list of topics, not {value!r}")
    return tuple(value)


def _flag(name: str, value: object) -> bool:
    if not isinstance(value, bool):
        raise SettingsError(f"{name} must be true or false, not {value!r}")
    return value


def _number(name: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise SettingsError(f"{name} must be a finite number, not {value!r}")
    return float(value)
