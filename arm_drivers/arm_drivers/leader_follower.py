"""arm_drivers/LeaderFollowerController: one arm follows another that is moved by hand."""

from dataclasses import dataclass

import numpy as np

from arm_control import Controller, InterfaceConfiguration, ReturnType, parameter
from arm_control.errors import ControllerError

ARRIVED_RAD = 0.05
"""How near each joint must come before the follower follows without a limit."""


@dataclass(frozen=True, slots=True)
class LeaderFollowerParameters:
    """Declared on the controller's node."""

    leader_joints: tuple[str, ...] = parameter((), "Joints that lead", read_only=True)
    follower_joints: tuple[str, ...] = parameter(
        (), "Joints that follow, in the same order", read_only=True
    )
    approach_velocity: float = parameter(
        0.5, "How fast the follower comes to the leader's pose at first, in rad/s"
    )


class LeaderFollowerController(Controller[LeaderFollowerParameters]):
    """Commands the follower's joints to the positions of the leader's.

    At first they may stand apart, so the follower comes slowly; then it follows in the same cycle.
    """

    parameters_type = LeaderFollowerParameters

    def on_configure(self, parameters: LeaderFollowerParameters) -> None:
        """Take the parameters and check the joints.

        Raises:
            ControllerError: there are none, or their numbers differ.
        """
        super().on_configure(parameters)
        leaders, followers = parameters.leader_joints, parameters.follower_joints
        if not leaders or len(leaders) != len(followers):
            raise ControllerError(
                f"leader_joints and follower_joints must be as many, and at least one; they are "
                f"{len(leaders)} and {len(followers)}"
            )

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the positions of the follower."""
        joints = self.parameters.follower_joints
        return InterfaceConfiguration.individual(f"{joint}/position" for joint in joints)

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read the positions of both, the leader's first."""
        joints = (*self.parameters.leader_joints, *self.parameters.follower_joints)
        return InterfaceConfiguration.individual(f"{joint}/position" for joint in joints)

    def on_activate(self) -> None:
        """Start where the follower is."""
        self._goals = self.states.read().reshape(2, -1)[1].copy()
        self._has_arrived = False

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Send the leader's positions, at first by small steps."""
        leader = self.states.read().reshape(2, -1)[0]
        if not self._has_arrived:
            reach = self.parameters.approach_velocity * period_s
            self._goals = self._goals + np.clip(leader - self._goals, -reach, reach)
            self._has_arrived = bool((np.abs(leader - self._goals) < ARRIVED_RAD).all())
        self.commands.write(leader if self._has_arrived else self._goals)
        return ReturnType.OK
