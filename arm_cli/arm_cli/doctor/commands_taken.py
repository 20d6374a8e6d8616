"""Do commands come in time, and to an active controller?"""

from dataclasses import dataclass

from arm_cli.doctor.finding import Finding
from arm_cli.doctor.observation import CommandTopic, Observation

NAME = "commands"
TOO_FAR_AHEAD_S = 10.0
TRY = "to send one: arm topic pub --once TOPIC TYPE VALUES"


@dataclass(frozen=True, slots=True)
class CommandsTaken:
    """Looks at the topics of set-points."""

    observation: Observation

    def examine(self) -> Finding:
        """Look for commands that nobody follows, or that are stale; say who is silent."""
        commands = self.observation.commands
        faults = [fault for topic in commands if (fault := _untaken(topic) or _untimely(topic))]
        if faults:
            return faults[0]
        moving = [topic.name for topic in commands if topic.received]
        if moving:
            return Finding.ok(NAME, f"commands come on {', '.join(moving)}")
        waiting = [topic.name for topic in commands if topic.listeners]
        if not waiting:
            return Finding.ok(NAME, "no controller listens for commands on a topic")
        where = ", ".join(waiting)
        return Finding.ok(NAME, f"none came on {where} while looking: the arm keeps its pose", TRY)


def _untaken(topic: CommandTopic) -> Finding | None:
    if not topic.publishers:
        return None
    source = f"{topic.name} is published by {' and '.join(topic.publishers)}"
    if not topic.listeners:
        return Finding.warning(
            NAME,
            f"{source}, but nobody listens: its controller is not loaded, or has another name",
            "arm control list_controllers shows the names; spawner NAME loads one",
        )
    if topic.received and topic.controller and topic.state != "active":
        return Finding.error(
            NAME,
            f"{source}, but {topic.controller} is {topic.state}",
            f"arm control switch_controllers --activate {topic.controller}",
        )
    return None


def _untimely(topic: CommandTopic) -> Finding | None:
    if topic.ahead_s is None:
        return None
    source = f"the last command on {topic.name}, from {' or '.join(topic.publishers)},"
    clock = "stamp with the simulation's clock (use_sim_time:=true), or with 0 for now"
    if topic.ahead_s > TOO_FAR_AHEAD_S:
        return Finding.error(
            NAME, f"{source} is stamped {topic.ahead_s:.0f} s ahead of the simulation's time", clock
        )
    if -topic.ahead_s > topic.lasting_s:
        return Finding.error(
            NAME,
            f"{source} is stale: it was over {-topic.ahead_s - topic.lasting_s:.1f} s ago",
            clock,
        )
    return None
