"""Inverse kinematics of a group for whichever link a pose is for.

Making one takes 1 ms, and 10 ms more when a search first starts anew; so keep them.
"""

import numpy as np
from numpy.typing import NDArray

from arm_planning.kinematics.inverse import InverseKinematics
from arm_planning.kinematics.search import Orientation
from arm_planning.robot.model import JointPositions, PlanningModel

Array = NDArray[np.float64]


class GroupKinematics:
    """Makes the inverse kinematics of each link once. For one thread at a time.

    Args:
        model: the robot.
        group: name of the group.
        positions: positions of joints outside of the group; 0 for those not named.
    """

    def __init__(
        self, model: PlanningModel, group: str, positions: JointPositions | None = None
    ) -> None:
        self._model, self._group, self._positions = model, group, positions
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
