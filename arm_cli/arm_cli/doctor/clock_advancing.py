"""Does simulated time go on?"""

from dataclasses import dataclass

from arm_cli.doctor.finding import Finding
from arm_cli.doctor.observation import Observation

NAME = "clock"
CLOCK = "/clock"


@dataclass(frozen=True, slots=True)
class ClockAdvancing:
    """Looks at /clock."""

    observation: Observation

    def examine(self) -> Finding:
        """Look whether a published clock moves."""
        publishers = self.observation.publishers.get(CLOCK, ())
        clock = self.observation.clock
        if not publishers:
            return Finding.ok(NAME, "nobody publishes /clock: time is the machine's")
        if clock is None or clock.simulated_s <= 0.0:
            return Finding.error(
                NAME,
                f"simulated time stands still: /clock is published by {' and '.join(publishers)}, "
                f"{'but nothing comes' if clock is None else 'always the same time'}",
                "look for an error in the simulation's terminal; start it again, or unpause it",
            )
        return Finding.ok(NAME, f"/clock goes on, from {', '.join(publishers)}")
