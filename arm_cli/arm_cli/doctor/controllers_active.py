"""Are the controllers active?"""

from dataclasses import dataclass

from arm_cli.doctor.finding import Finding
from arm_cli.doctor.observation import ControlState, Observation

NAME = "controllers"
NEXT_STATE = {"unconfigured": "inactive", "inactive": "active"}


@dataclass(frozen=True, slots=True)
class ControllersActive:
    """Looks at the controllers of all managers."""

    observation: Observation

    def examine(self) -> Finding:
        """Look for a manager without answer or controllers, then for one that is not active."""
        managers = self.observation.managers
        if not managers:
            return _without_manager(is_simulated=self.observation.is_timed)
        faults = [fault for manager in managers if (fault := _fault(manager))]
        if faults:
            return max(faults, key=lambda fault: fault.severity == "error")
        names = [c.name for manager in managers for c in manager.controllers]
        return Finding.ok(NAME, f"{', '.join(names)} active")


def _without_manager(is_simulated: bool) -> Finding:
    sentence = "there is no controller manager: nothing can move the arm"
    fix = "arm launch; for hardware of your own: arm launch arm_control arm_mock.launch.py"
    if is_simulated:
        return Finding.error(NAME, sentence, fix)
    return Finding.warning(NAME, f"{sentence}; right where it is only displayed", fix)


def _fault(manager: ControlState) -> Finding | None:
    if not manager.answered:
        return Finding.error(
            NAME,
            f"{manager.manager} does not answer: it is stuck or has gone",
            "stop the simulation (Ctrl-C) and start it again",
        )
    if not manager.controllers:
        return Finding.error(
            NAME,
            f"{manager.manager} has loaded no controllers",
            f"spawner joint_state_broadcaster position_controller{manager.option}",
        )
    resting = next((c for c in manager.controllers if c.state != "active"), None)
    if resting is None:
        return None
    state = NEXT_STATE.get(resting.state, "active")
    return Finding.warning(
        NAME,
        f"{resting.name} is {resting.state}: it takes no commands and publishes nothing",
        f"arm control set_controller_state {resting.name} {state}{manager.option}",
    )
