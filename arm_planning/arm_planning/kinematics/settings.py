"""The settings of inverse kinematics in a kinematics.yaml."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from arm_node.names import describe_known
from arm_planning.kinematics.search import Orientation
from arm_planning.robot.model import PlanningModel
from arm_planning.setting_values import number, switch

TIMEOUT, POSITION_ONLY = "kinematics_solver_timeout", "position_only_ik"


@dataclass(frozen=True, slots=True)
class KinematicsSettings:
    """How poses of a group are solved.

    Attributes:
        timeout_s: length of a search that asks for none; 0 for the default.
        position_only: whether the orientation of a pose does not matter.
    """

    timeout_s: float = 0.0
    position_only: bool = False

    @property
    def orientation(self) -> Orientation:
        """What a solution owes to a pose's orientation."""
        return Orientation.ANY if self.position_only else Orientation.EXACT


def kinematics_settings(
    values: Mapping[str, object], model: PlanningModel, warn: Callable[[str], None]
) -> dict[str, KinematicsSettings]:
    """Return the settings of each group that has some.

    Other keys choose or tune solvers that are not here, and are passed over.

    Args:
        values: the values below robot_description_kinematics, with dotted names.
        model: the robot.
        warn: takes a sentence about a group that does not exist.

    Raises:
        PlanningError: FAILURE: a value has the wrong type, or a timeout is negative.
    """
    groups = dict.fromkeys(name.partition(".")[0] for name in values)
    for group in groups:
        if group not in model.groups:
            known = describe_known(group, model.groups, "the robot has")
            warn(f"robot_description_kinematics names the group '{group}'; {known}")
    return {
        group: KinematicsSettings(
            number(*_given(values, f"{group}.{TIMEOUT}", 0.0), least=0.0),
            switch(*_given(values, f"{group}.{POSITION_ONLY}", default=False)),
        )
        for group in groups
        if group in model.groups
    }


def _given(values: Mapping[str, object], name: str, default: object) -> tuple[str, object]:
    return f"robot_description_kinematics.{name}", values.get(name, default)
