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
            return self._unpublished()
        if clock is None or clock.simulated_s <= 0.0:
            return Finding.error(
                NAME,
                f"simulated time stands still: /clock is published by {' and '.join(publishers)}, "
                f"{'but nothing comes' if clock is None else 'always the same time'}",
                "look for an error in the simulation's terminal; start it again, or unpause it",
            )
        return Finding.ok(NAME, f"/clock goes on, from {', '.join(publishers)}")

    def _unpublished(self) -> Finding:
        readers = self.observation.clock_readers
        if not readers:
            return Finding.ok(NAME, "nobody publishes /clock: time is the machine's")
        return Finding.error(
            NAME,
            "nobody publishes /clock: time stands still for those who go by it: "
            f"{', '.join(readers)}",
            "start the simulation (arm launch), again where it is stuck; or start them without "
            "use_sim_time:=true",
        )
