"""The limits of joints: those of the URDF, replaced one by one by those of joint_limits.yaml."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, fields

from arm_description.urdf.robot import Joint
from arm_node.limited_yaml import YamlError, load_yaml
from arm_node.names import describe_known, listing
from arm_node.parameter_file import flat_parameters
from arm_planning.errors import PlanningError, SettingError
from arm_planning.robot.model import PlanningLimits
from arm_planning.setting_values import number, switch

RAMP_S = 0.5
"""Time to full speed, for joints without an acceleration limit: a URDF cannot give one."""
JOINTS = "joint_limits."
UNUSED = ("has_effort_limits", "max_effort")
"""Keys that the files of MoveIt have, and that do not concern planning."""

Warn = Callable[[str], None]
"""Takes a sentence for the user about something that is not an error."""


@dataclass(frozen=True, slots=True)
class GivenLimits:
    """The keys of one joint in joint_limits.yaml; None for a key that is not given.

    A maximum counts unless its `has_` key is false. Units: rad or m, per s, s^2 and s^3.
    """

    has_position_limits: bool | None = None
    min_position: float | None = None
    max_position: float | None = None
    has_velocity_limits: bool | None = None
    max_velocity: float | None = None
    has_acceleration_limits: bool | None = None
    max_acceleration: float | None = None
    has_deceleration_limits: bool | None = None
    max_deceleration: float | None = None
    has_jerk_limits: bool | None = None
    max_jerk: float | None = None


@dataclass(frozen=True, slots=True)
class JointLimitSettings:
    """The content of joint_limits.yaml.

    Attributes:
        joints: the keys of each joint.
        velocity_scaling: fraction of the velocity limits that a client uses by itself.
        acceleration_scaling: likewise of the acceleration limits.
    """

    joints: Mapping[str, GivenLimits] = field(default_factory=dict)
    velocity_scaling: float = 0.1
    acceleration_scaling: float = 0.1


def read_joint_limits(text: str, source: str, warn: Warn) -> JointLimitSettings:
    """Return the limits in the text of a joint_limits.yaml.

    Raises:
        PlanningError: the text is not YAML, or see `joint_limit_settings`; the message names the
            source.
    """
    try:
        content = load_yaml(text)
    except YamlError as error:
        raise SettingError(f"{source} is not YAML: {error}") from error
    if not isinstance(content, Mapping | None):
        raise SettingError(f"{source} is not a mapping; it has the key 'joint_limits'")
    try:
        return joint_limit_settings(content or {}, lambda text: warn(f"{source}: {text}"))
    except PlanningError as error:
        raise SettingError(f"{source}: {error}") from error


def joint_limit_settings(values: Mapping[str, object], warn: Warn) -> JointLimitSettings:
    """Return the limits among parameters.

    Args:
        values: the parameters below robot_description_planning, nested or with dotted names. Those
            of other files, such as cartesian_limits, are passed over.
        warn: is told of keys that do not exist.

    Raises:
        PlanningError: a value has another type, or is not a limit.
    """
    joints: dict[str, dict[str, bool | float]] = {}
    scaling = {"velocity": 0.1, "acceleration": 0.1}
    kinds = {each.name: _kind(each.name) for each in fields(GivenLimits)}
    for name, value in flat_parameters(values):
        if name.startswith(JOINTS):
            joint, _, key = name.removeprefix(JOINTS).rpartition(".")
            if key in kinds:
                joints.setdefault(joint, {})[key] = _value(name, value, kinds[key])
            elif key not in UNUSED:
                warn(f"{name} is passed over: {describe_known(key, kinds, 'the keys are')}")
        for kind in scaling:
            if name == f"default_{kind}_scaling_factor":
                scaling[kind] = number(name, value, above=0.0, most=1.0)
    given = {joint: GivenLimits(**keys) for joint, keys in joints.items()}  # pyright: ignore[reportArgumentType]
    return JointLimitSettings(given, scaling["velocity"], scaling["acceleration"])


def limits_of(
    joints: Iterable[Joint], settings: JointLimitSettings, warn: Warn
) -> dict[str, PlanningLimits]:
    """Return the limits of scalar joints by name.

    A joint without a velocity limit gets its type's usual speed, one without an acceleration limit
    reaches full speed in half a second; one warning names the joints.

    Raises:
        PlanningError: the limits of a joint contradict each other.
    """
    result: dict[str, PlanningLimits] = {}
    no_velocity: list[str] = []
    no_acceleration: list[str] = []
    for joint in joints:
        given = settings.joints.get(joint.name, GivenLimits())
        velocity = _velocity(joint, given)
        if math.isinf(velocity):
            velocity = joint.type.default_speed
            no_velocity.append(f"{joint.name} ({velocity:g} {joint.type.unit}/s)")
        acceleration = _maximum(given.has_acceleration_limits, given.max_acceleration)
        if math.isinf(acceleration):
            acceleration = velocity / RAMP_S
            no_acceleration.append(f"{joint.name} ({acceleration:.3g} {joint.type.unit}/s^2)")
        lower, upper = _range(joint, given, warn)
        jerk = _maximum(given.has_jerk_limits, given.max_jerk)
        result[joint.name] = PlanningLimits(lower, upper, velocity, acceleration, jerk)
    assumed = [
        f"without {kind} limit: {listing(names)}"
        for kind, names in (("a velocity", no_velocity), ("an acceleration", no_acceleration))
        if names
    ]
    if assumed:
        warn(
            f"joints {'; '.join(assumed)}: these values are assumed, set them in joint_limits.yaml"
        )
    return result


def _range(joint: Joint, given: GivenLimits, warn: Warn) -> tuple[float, float]:
    """Return the lowest and the highest position."""
    lower, upper = -math.inf, math.inf
    if joint.limit is not None:
        lower, upper = joint.limit.lower, joint.limit.upper
    if joint.safety is not None:
        lower, upper = max(lower, joint.safety.soft_lower), min(upper, joint.safety.soft_upper)
    if given.has_position_limits is False:
        if joint.type.turns:
            return -math.inf, math.inf
        warn(f"joint '{joint.name}' slides, so it keeps the limits of the URDF")
        return lower, upper
    lower = lower if given.min_position is None else given.min_position
    upper = upper if given.max_position is None else given.max_position
    if not lower <= upper:
        raise SettingError(
            f"joint '{joint.name}' has the lower limit {lower:g} above the upper limit {upper:g}"
        )
    return lower, upper


def _velocity(joint: Joint, given: GivenLimits) -> float:
    """Return the highest speed; as in MoveIt, a URDF's 0 stands for none."""
    if given.has_velocity_limits is None and given.max_velocity is None:
        return (joint.limit.velocity if joint.limit else 0.0) or math.inf
    return _maximum(given.has_velocity_limits, given.max_velocity)


def _maximum(is_limited: bool | None, maximum: float | None) -> float:
    return math.inf if maximum is None or is_limited is False else maximum


def _kind(key: str) -> str:
    if key.startswith("has_"):
        return "bool"
    return "number" if key.endswith("_position") else "maximum"


def _value(name: str, value: object, kind: str) -> bool | float:
    if kind == "bool":
        return switch(name, value)
    if kind == "number":
        return number(name, value)
    # Decelerations are negative in Pilz' files.
    limit = abs(number(name, value)) if name.endswith("max_deceleration") else value
    return number(name, limit, above=0.0)
