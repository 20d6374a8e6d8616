"""The limits of the tip's motion: those of pilz_cartesian_limits.yaml."""

from collections.abc import Mapping
from dataclasses import dataclass, fields

from arm_node.names import describe_known
from arm_node.parameter_file import flat_parameters
from arm_planning.errors import SettingError
from arm_planning.setting_values import number

_PREFIX = "cartesian_limits."


@dataclass(frozen=True, slots=True)
class CartesianLimits:
    """Limits of the tip, named as in pilz_cartesian_limits.yaml.

    Attributes:
        max_trans_vel: speed, m/s.
        max_trans_acc: acceleration along the path, m/s^2.
        max_trans_dec: deceleration along the path, m/s^2, negative.
        max_rot_vel: turning speed, rad/s.
    """

    max_trans_vel: float = 1.0
    max_trans_acc: float = 2.25
    max_trans_dec: float = -5.0
    max_rot_vel: float = 1.57

    @property
    def metres_per_rad(self) -> float:
        """How long a path one radian counts as, so that its turning speed holds the limit."""
        return self.max_trans_vel / self.max_rot_vel


def cartesian_limits(values: Mapping[str, object]) -> CartesianLimits:
    """Return the limits among parameters; those not given have the defaults above.

    Args:
        values: the parameters below robot_description_planning, nested or with dotted names.

    Raises:
        PlanningError: FAILURE: a limit does not exist, is not a number or has the wrong sign.
    """
    known = [each.name for each in fields(CartesianLimits)]
    given: dict[str, float] = {}
    for name, value in flat_parameters(values):
        if not name.startswith(_PREFIX):
            continue
        key = name.removeprefix(_PREFIX)
        if key not in known:
            raise SettingError(f"no limit '{name}'; {describe_known(key, known, 'there are')}")
        if key == "max_trans_dec":
            given[key] = number(name, value, below=0.0)
        else:
            given[key] = number(name, value, above=0.0)
    return CartesianLimits(**given)
