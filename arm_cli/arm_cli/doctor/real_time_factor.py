"""Is the simulation as fast as it should be?"""

from dataclasses import dataclass

from arm_cli.doctor.finding import Finding
from arm_cli.doctor.observation import Observation

NAME = "real-time factor"
LEAST_SHARE = 0.9


@dataclass(frozen=True, slots=True)
class RealTimeFactor:
    """Compares simulated with wall time."""

    observation: Observation

    def examine(self) -> Finding:
        """Look how far time went, against what was asked for."""
        clock = self.observation.clock
        if clock is None or clock.wall_s <= 0.0:
            return Finding.ok(NAME, "no simulated time to measure")
        factor = clock.simulated_s / clock.wall_s
        wanted = clock.wanted_factor
        if wanted and factor < LEAST_SHARE * wanted:
            return Finding.warning(
                NAME,
                f"{factor:.2f} instead of {wanted:g}: the machine is too slow or too busy",
                "end other programs; camera:=none or a smaller picture; a larger physics_step",
            )
        meant = (
            "" if wanted is None else ", as fast as possible" if not wanted else f" of {wanted:g}"
        )
        return Finding.ok(NAME, f"{factor:.2f}{meant}")
