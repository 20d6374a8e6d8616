"""Does somebody say where the joints are?"""

from dataclasses import dataclass

from arm_cli.doctor.finding import Finding
from arm_cli.doctor.observation import Observation, StateTopic

NAME = "joint states"
START = (
    "start the simulation (arm launch), again where it is stuck; "
    "where only the broadcaster is missing: spawner joint_state_broadcaster"
)


@dataclass(frozen=True, slots=True)
class JointStatesCome:
    """Looks at /joint_states, in every namespace."""

    observation: Observation

    def examine(self) -> Finding:
        """Look for a topic that stays silent; where all do, nothing shows how the arm moves."""
        topics = self.observation.joint_states
        silent = [_silence(topic) for topic in topics if not topic.received]
        coming = [topic.name for topic in topics if topic.received]
        if not topics:
            silent = ["nobody publishes /joint_states"]
        if not coming:
            return Finding.error(
                NAME, f"{silent[0]}: the arm is seen at rest, or not at all", START
            )
        if silent:
            return Finding.warning(NAME, silent[0], START)
        return Finding.ok(NAME, f"they come on {', '.join(coming)}")


def _silence(topic: StateTopic) -> str:
    if topic.publishers:
        return f"{topic.name} is published by {' and '.join(topic.publishers)}, but nothing comes"
    return f"nobody publishes {topic.name}, which {' and '.join(topic.listeners)} listens to"
