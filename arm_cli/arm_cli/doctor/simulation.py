"""Checks of a running simulation's topics, clock and nodes."""

import xml.etree.ElementTree as ET
from collections import Counter

from arm_cli.doctor.diagnosis import Diagnosis
from arm_cli.doctor.observation import GraphObservation, StateTopic

PUBLISH_DESCRIPTION = (
    "start the state publisher, as arm launch does; in a launch file: "
    'Node(package="robot_state_publisher", executable="robot_state_publisher", '
    'parameters=[{"robot_description": Command(["xacro ", FILE])}])'
)
CLOCK = "/clock"
START_SIMULATION = (
    "start the simulation (arm launch), or restart it if it is stuck; "
    "if only the broadcaster is missing: spawner joint_state_broadcaster"
)

CHECK_DRIVER = (
    "the driver does not set these states: look at its log; "
    "arm control list_hardware_interfaces shows the states that it declares"
)
INTERFACES_SHOWN = 6
LEAST_SHARE = 0.9
MISMATCHES_SHOWN = 3
PAGE = "/arm_viewer"
"""The page also subscribes to topics that have no publisher yet."""
SINGLE = ("joint_states", "clock")


def check_description(observation: GraphObservation) -> Diagnosis:
    """Check that a robot description is published and is a URDF."""
    found = observation.descriptions
    if not found:
        return Diagnosis.error(
            "description", "nobody publishes /robot_description", PUBLISH_DESCRIPTION
        )
    for topic, text in found.items():
        if not text:
            return Diagnosis.error(
                "description",
                f"{topic} has a publisher, but no description arrived",
                "publish it with durability transient_local, for late subscribers",
            )
        fault = _urdf_fault(text)
        if fault:
            return Diagnosis.error(
                "description",
                f"the description on {topic} is not a URDF: {fault}",
                "check the file: arm check FILE",
            )
    return Diagnosis.ok("description", f"a robot on {', '.join(found)}")


def _urdf_fault(text: str) -> str:
    try:
        root = ET.fromstring(text)
    except ET.ParseError as error:
        return str(error)
    if root.tag != "robot":
        return f"its root element is <{root.tag}>"
    return "" if root.find("link") is not None else "it has no <link>"


def check_clock(observation: GraphObservation) -> Diagnosis:
    """Check that a published clock advances."""
    publishers = observation.publishers.get(CLOCK, ())
    clock = observation.clock
    if not publishers:
        return _without_clock(observation)
    if clock is None or clock.simulated_s <= 0.0:
        return Diagnosis.error(
            "clock",
            f"simulated time stands still: /clock is published by {' and '.join(publishers)}, "
            f"{'but no message arrives' if clock is None else 'but its time does not change'}",
            "look for an error in the simulation's terminal; start it again, or unpause it",
        )
    return Diagnosis.ok("clock", f"/clock advances, from {', '.join(publishers)}")


def _without_clock(observation: GraphObservation) -> Diagnosis:
    readers = observation.clock_readers
    if not readers:
        return Diagnosis.ok("clock", "nobody publishes /clock: nodes use the system clock")
    return Diagnosis.error(
        "clock",
        f"nobody publishes /clock: time stands still for nodes that use it: {', '.join(readers)}",
        "start the simulation (arm launch), or restart it if it is stuck; or start these nodes "
        "without use_sim_time:=true",
    )


def check_joint_states(observation: GraphObservation) -> Diagnosis:
    """Check that joint states arrive, and that they are numbers."""
    topics = observation.joint_states
    silent = [topic for topic in topics if not topic.received]
    arriving = [topic.name for topic in topics if topic.received]
    if not arriving:
        silence = _silence(silent[0]) if silent else "nobody publishes /joint_states"
        return Diagnosis.error(
            "joint states",
            f"{silence}: the arm is displayed at rest, or not at all",
            START_SIMULATION,
        )
    unmeasured = _unmeasured(observation)
    if unmeasured:
        return Diagnosis.error("joint states", unmeasured, CHECK_DRIVER)
    missed = [topic for topic in silent if topic.publishers or set(topic.listeners) - {PAGE}]
    if missed:
        return Diagnosis.warning("joint states", _silence(missed[0]), START_SIMULATION)
    return Diagnosis.ok("joint states", f"they arrive on {', '.join(arriving)}")


def _unmeasured(observation: GraphObservation) -> str:
    """Return a sentence about joint states that should be numbers and are NaN, "" if none are.

    The broadcaster writes NaN for an interface that a joint lacks. So a NaN is a fault only if the
    hardware has that interface, or if it is a position of a joint that no hardware has.
    """
    offered = {
        name
        for manager in observation.managers
        for component in manager.hardware
        for name in component.states
    }
    known = {name.rpartition("/")[0] for name in offered}
    for topic in observation.joint_states:
        faulty = [name for name in topic.not_numbers if _should_be_known(name, offered, known)]
        if faulty:
            shown = ", ".join(faulty[:INTERFACES_SHOWN]) + (
                " ..." if len(faulty) > INTERFACES_SHOWN else ""
            )
            verb = "is not a number" if len(faulty) == 1 else "are not numbers"
            return f"{shown} {verb} on {topic.name}: the arm's position is unknown"
    return ""


def _should_be_known(name: str, offered: set[str], known_joints: set[str]) -> bool:
    joint, _, kind = name.rpartition("/")
    return name in offered or (joint not in known_joints and kind == "position")


def _silence(topic: StateTopic) -> str:
    if topic.publishers:
        return (
            f"{topic.name} is published by {' and '.join(topic.publishers)}, but no message arrives"
        )
    verb = "subscribes" if len(topic.listeners) == 1 else "subscribe"
    return f"nobody publishes {topic.name}, to which {' and '.join(topic.listeners)} {verb}"


def check_real_time_factor(observation: GraphObservation) -> Diagnosis:
    """Compare the real-time factor with the requested one."""
    clock = observation.clock
    if clock is None or clock.wall_s <= 0.0:
        return Diagnosis.ok("real-time factor", "no simulated time to measure")
    factor = clock.simulated_s / clock.wall_s
    wanted = clock.wanted_factor
    if wanted and factor < LEAST_SHARE * wanted:
        return Diagnosis.warning(
            "real-time factor",
            f"{factor:.2f} instead of {wanted:g}: the machine is too slow or too busy",
            "end other programs; use camera:=none, a smaller picture or a larger physics_step",
        )
    meant = "" if wanted is None else ", as fast as possible" if not wanted else f" of {wanted:g}"
    return Diagnosis.ok("real-time factor", f"{factor:.2f}{meant}")


def check_qos(observation: GraphObservation) -> Diagnosis:
    """Check that the QoS of publishers and subscriptions is compatible."""
    found = observation.mismatches
    if not found:
        return Diagnosis.ok("QoS", "all publishers and subscriptions are compatible")
    said = [f"{m.topic} from {m.publisher} to {m.subscription}: {m.reason}" for m in found]
    more = f"; and {len(said) - MISMATCHES_SHOWN} more" if len(said) > MISMATCHES_SHOWN else ""
    return Diagnosis.warning(
        "QoS",
        f"no message passes on {'; '.join(said[:MISMATCHES_SHOWN])}{more}",
        "request no more than the publisher offers: best effort and volatile match all publishers; "
        f"arm topic info -v {found[0].topic}",
    )


def check_publishers(observation: GraphObservation) -> Diagnosis:
    """Check that /joint_states and /clock have no second publisher."""
    for topic, nodes in observation.publishers.items():
        if topic.rpartition("/")[2] in SINGLE and len(nodes) > 1:
            return Diagnosis.error(
                "duplicate publishers",
                f"{topic} is published by {' and '.join(nodes)}: their messages alternate",
                "end one of them; if another simulation runs, give it another ROS_DOMAIN_ID",
            )
    return Diagnosis.ok("duplicate publishers", "/joint_states and /clock have no second publisher")


def check_node_names(observation: GraphObservation) -> Diagnosis:
    """Check that no two nodes have the same name."""
    shared = sorted(n for n, count in Counter(observation.nodes).items() if count > 1)
    if not shared:
        return Diagnosis.ok("node names", "no two nodes have the same name")
    verb = "is the name" if len(shared) == 1 else "are the names"
    return Diagnosis.warning(
        "node names",
        f"{' and '.join(shared)} {verb} of several nodes: a parameter may be set on one of them "
        "and read from another",
        "end all but one; `arm launch` with replace:=true ends such a node before it starts "
        "another",
    )
