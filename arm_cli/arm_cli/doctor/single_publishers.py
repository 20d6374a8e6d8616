"""Does only one node publish what only one may?"""

from dataclasses import dataclass

from arm_cli.doctor.finding import Finding
from arm_cli.doctor.observation import Observation

NAME = "duplicate publishers"
SINGLE = ("joint_states", "clock")


@dataclass(frozen=True, slots=True)
class SinglePublishers:
    """Looks at /clock, and at /joint_states in every namespace."""

    observation: Observation

    def examine(self) -> Finding:
        """Look for a second publisher."""
        for topic, nodes in self.observation.publishers.items():
            if topic.rpartition("/")[2] in SINGLE and len(nodes) > 1:
                return Finding.error(
                    NAME,
                    f"{topic} is published by {' and '.join(nodes)}: readers see them in turn",
                    "end one of them; if another simulation runs, give it another ROS_DOMAIN_ID",
                )
        return Finding.ok(NAME, "/joint_states and /clock have no second publisher")
