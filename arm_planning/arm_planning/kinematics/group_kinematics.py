"""Inverse kinematics of a group for whichever link a pose is for, and its settings.

Making one takes 1 ms, and 10 ms more when a search first starts anew; so keep them.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from arm_node.names import describe_known
from arm_planning.kinematics.inverse import InverseKinematics
from arm_planning.kinematics.search import Orientation
from arm_planning.robot.model import JointPositions, PlanningModel
from arm_planning.setting_values import number, switch

Array = NDArray[np.float64]
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


class GroupKinematics:
    """Makes the inverse kinematics of each link once. For one thread at a time.

    Args:
        model: the robot.
        group: name of the group.
        positions: positions of joints outside of the group; 0 for those not named.
        settings: how the group's poses are solved.
    """

    def __init__(
        self,
        model: PlanningModel,
        group: str,
        positions: JointPositions | None = None,
        settings: KinematicsSettings = KinematicsSettings(),
    ) -> None:
        self._model, self._group, self._positions = model, group, positions
        self.settings = settings
        self._by_link: dict[str, InverseKinematics] = {}

    def of(self, link: str = "") -> InverseKinematics:
        """Return the inverse kinematics of a link; "" for the group's tip.

        Raises:
            PlanningError: as `InverseKinematics`.
        """
        if link not in self._by_link:
            made = InverseKinematics(self._model, self._group, link, self._positions)
            self._by_link[link] = self._by_link[made.tip] = made
        return self._by_link[link]

    def __call__(
        self, link: str, pose: Array, seed: Array, *, most: int, random_seed: int, any_turn: bool
    ) -> list[Array]:
        """Return positions, (n,), that bring a link to a pose.

        Args:
            link: the link.
            pose: its pose in the planning frame, (4, 4).
            seed: where to start, (n,).
            most: number of solutions at most, the nearest to the seed first; 1: the first found.
            random_seed: seed of the random starts.
            any_turn: whether the orientation does not matter.

        Raises:
            PlanningError: NO_IK_SOLUTION: there is none; the message says why.
        """
        kinematics = self.of(link)
        orientation = Orientation.ANY if any_turn else Orientation.EXACT
        if most == 1:
            found = kinematics.solve(pose, seed, random_seed=random_seed, orientation=orientation)
            return [found]
        return kinematics.solutions(
            pose, seed, most=most, random_seed=random_seed, orientation=orientation
        )
