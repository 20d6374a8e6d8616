"""Do the two ends of every topic talk to each other?"""

from dataclasses import dataclass

from arm_cli.doctor.finding import Finding
from arm_cli.doctor.observation import Observation

NAME = "QoS"
SHOWN = 3


@dataclass(frozen=True, slots=True)
class QosMatches:
    """Looks for publishers and subscriptions that never exchange a message."""

    observation: Observation

    def examine(self) -> Finding:
        """Name the first of them."""
        found = self.observation.mismatches
        if not found:
            return Finding.ok(NAME, "all publishers and subscriptions of a topic fit")
        said = [f"{m.topic} from {m.publisher} to {m.subscription}: {m.reason}" for m in found]
        more = f"; and {len(said) - SHOWN} more" if len(said) > SHOWN else ""
        return Finding.warning(
            NAME,
            f"no message passes on {'; '.join(said[:SHOWN])}{more}",
            "subscribe with no more than the publisher offers: best effort and volatile fit all; "
            f"arm topic info -v {found[0].topic}",
        )
