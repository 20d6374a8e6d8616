"""Does a controller command every joint?"""

from dataclasses import dataclass

from arm_cli.doctor.finding import Finding
from arm_cli.doctor.observation import ControlState, Observation

NAME = "claims"


@dataclass(frozen=True, slots=True)
class JointsClaimed:
    """Looks for joints none of whose command interfaces is claimed."""

    observation: Observation

    def examine(self) -> Finding:
        """Look at each manager; a robot that nothing can move is an error."""
        count = 0
        for manager in self.observation.managers:
            joints = _joints(manager)
            count += len(joints)
            free = [joint for joint, claimed in joints.items() if not claimed]
            fix = _fix(manager)
            if free and len(free) == len(joints):
                return Finding.error(
                    NAME,
                    f"no active controller commands a joint of {manager.manager}: nothing can "
                    "move it",
                    fix,
                )
            if free:
                return Finding.warning(
                    NAME, f"no active controller commands {', '.join(free)}", fix
                )
        return Finding.ok(NAME, f"{count} joints are commanded by active controllers")


def _joints(manager: ControlState) -> dict[str, bool]:
    """Return whether anything of each joint is claimed, such as of "j0" in "j0/position"."""
    joints: dict[str, bool] = {}
    for component in manager.hardware:
        for interface, claimed in component.claimed.items():
            joint = interface.rpartition("/")[0]
            joints[joint] = joints.get(joint, False) or claimed
    return joints


def _fix(manager: ControlState) -> str:
    resting = [c.name for c in manager.controllers if c.state == "inactive"]
    if resting:
        return f"arm control switch_controllers --activate {resting[0]}{manager.option}"
    return f"spawner position_controller{manager.option}, or another that commands the joints"
