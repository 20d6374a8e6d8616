"""servo_arm/PdController: holds joints at a target by commanding efforts."""

from dataclasses import dataclass

from arm_control import Controller, InterfaceConfiguration, ReturnType, parameter


@dataclass(frozen=True, slots=True)
class PdParameters:
    """Declared on the controller's node; `ros2 param set` changes them immediately."""

    joints: tuple[str, ...] = parameter((), "Joints to hold", read_only=True)
    target: float = parameter(0.0, "Where to hold them, in rad")
    p: float = parameter(1.0, "Effort per rad of error, in N m")
    d: float = parameter(0.1, "Effort per rad/s, in N m s")


class PdController(Controller[PdParameters]):
    """Pulls each joint to the target like a damped spring."""

    parameters_type = PdParameters

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the effort of each joint."""
        return self._interfaces("effort")

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read all positions, then all velocities."""
        return self._interfaces("position", "velocity")

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Compute the efforts of this cycle."""
        position, velocity = self.states.read().reshape(2, -1)
        now = self.parameters
        self.commands.write(now.p * (now.target - position) - now.d * velocity)
        return ReturnType.OK

    def on_deactivate(self) -> None:
        """Command zero effort."""
        self.commands.write(0.0)

    def _interfaces(self, *kinds: str) -> InterfaceConfiguration:
        joints = self.parameters.joints
        return InterfaceConfiguration.individual(f"{j}/{kind}" for kind in kinds for j in joints)
