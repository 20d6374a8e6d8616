"""Tells whether what the page shows is still alive."""

from arm_viewer.snapshot import Snapshot

SILENT_S = 2.0
WAITING = "Waiting for a robot on /robot_description"
GONE = "The simulation went away; the page goes on when it returns"
SILENT = "Nothing on {topic} for {silence:.0f} s: the simulation is paused, or hangs"


def complaint(snapshot: Snapshot) -> str:
    """Return what the user is told, empty where all is well."""
    if not snapshot.descriptions:
        return WAITING
    published = {topic.name for topic in snapshot.topics if topic.publishers}
    for topic, states in sorted(snapshot.joint_states.items()):
        silence_s = snapshot.made_s - states.received_s
        if silence_s > SILENT_S:
            is_there = topic in published
            return SILENT.format(topic=topic, silence=silence_s) if is_there else GONE
    return ""
