"""Is the hardware active?"""

from dataclasses import dataclass

from arm_cli.doctor.finding import Finding
from arm_cli.doctor.observation import Observation

NAME = "hardware"


@dataclass(frozen=True, slots=True)
class HardwareActive:
    """Looks at the hardware components of all managers."""

    observation: Observation

    def examine(self) -> Finding:
        """Look for a component that does not take commands."""
        active: list[str] = []
        for manager in self.observation.managers:
            for component in manager.hardware:
                if component.state != "active":
                    return Finding.error(
                        NAME,
                        f"{component.name} is {component.state}: it takes no commands",
                        f"arm control set_hardware_component_state {component.name} active"
                        f"{manager.option}",
                    )
                active.append(component.name)
        if not active and any(manager.answered for manager in self.observation.managers):
            return Finding.error(
                NAME,
                "the controller manager has no hardware",
                "give the description a <ros2_control> block; arm check FILE shows what is read",
            )
        return Finding.ok(NAME, f"{', '.join(active)} active" if active else "none to ask for")
