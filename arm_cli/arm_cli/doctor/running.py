"""Checks of a running simulation: its description, topics, clock, controllers and hardware."""

import xml.etree.ElementTree as ET
from collections import Counter

from arm_cli.doctor.diagnosis import Diagnosis
from arm_cli.doctor.observation import ControlState, GraphObservation, SetpointTopic, StateTopic

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


NEXT_STATE = {"unconfigured": "inactive", "inactive": "active"}
TOO_FAR_AHEAD_S = 10.0
SEND_ONE = "to send one: arm topic pub --once TOPIC TYPE VALUES"


def check_hardware(observation: GraphObservation) -> Diagnosis:
    """Check that every hardware component is active."""
    active: list[str] = []
    for manager in observation.managers:
        for component in manager.hardware:
            if component.state != "active":
                return Diagnosis.error(
                    "hardware",
                    f"{component.name} is {component.state}: it takes no commands",
                    f"arm control set_hardware_component_state {component.name} active"
                    f"{manager.option}",
                )
            active.append(component.name)
    if not active and any(manager.answered for manager in observation.managers):
        return Diagnosis.error(
            "hardware",
            "the controller manager has no hardware",
            "add a <ros2_control> block to the description; arm check FILE shows what is read",
        )
    return Diagnosis.ok("hardware", f"{', '.join(active)} active" if active else "nothing to check")


def check_controllers(observation: GraphObservation) -> Diagnosis:
    """Check that every manager answers and has controllers, and that all of them are active."""
    managers = observation.managers
    if not managers:
        return _without_manager(is_simulated=observation.is_timed)
    if observation.stopped:
        return Diagnosis.error(
            "controllers",
            f"an emergency stop is latched ({', '.join(observation.stopped)} is true): nothing is "
            "commanded",
            "arm stop --release",
        )
    faults = [fault for manager in managers if (fault := _controller_fault(manager))]
    if faults:
        return max(faults, key=lambda fault: fault.severity == "error")
    names = [c.name for manager in managers for c in manager.controllers]
    return Diagnosis.ok("controllers", f"{', '.join(names)} active")


def _without_manager(is_simulated: bool) -> Diagnosis:
    sentence = "there is no controller manager: nothing can move the arm"
    fix = "arm launch; for your own hardware: arm launch arm_control arm_mock.launch.py"
    if is_simulated:
        return Diagnosis.error("controllers", sentence, fix)
    return Diagnosis.warning("controllers", f"{sentence}; fine if it is only displayed", fix)


def _controller_fault(manager: ControlState) -> Diagnosis | None:
    if not manager.answered:
        return Diagnosis.error(
            "controllers",
            f"{manager.manager} does not answer: it hangs or has ended",
            "stop the simulation (Ctrl-C) and start it again",
        )
    if not manager.controllers:
        return Diagnosis.error(
            "controllers",
            f"{manager.manager} has loaded no controllers",
            f"spawner joint_state_broadcaster position_controller{manager.option}",
        )
    inactive = next((c for c in manager.controllers if c.state != "active"), None)
    if inactive is None:
        return None
    state = NEXT_STATE.get(inactive.state, "active")
    return Diagnosis.warning(
        "controllers",
        f"{inactive.name} is {inactive.state}: it takes no commands and publishes nothing",
        f"arm control set_controller_state {inactive.name} {state}{manager.option}",
    )


def check_claims(observation: GraphObservation) -> Diagnosis:
    """Check that active controllers command the joints; a robot without any is an error."""
    count = 0
    for manager in observation.managers:
        joints = _joints(manager)
        count += len(joints)
        free = [joint for joint, claimed in joints.items() if not claimed]
        fix = _claiming_command(manager)
        if free and len(free) == len(joints):
            return Diagnosis.error(
                "claims",
                f"no active controller commands a joint of {manager.manager}: nothing can move it",
                fix,
            )
        if free:
            return Diagnosis.warning(
                "claims", f"no active controller commands {', '.join(free)}", fix
            )
    return Diagnosis.ok("claims", f"{count} joints are commanded by active controllers")


def _joints(manager: ControlState) -> dict[str, bool]:
    """Return whether any command interface of each joint is claimed, by the joint's name."""
    joints: dict[str, bool] = {}
    for component in manager.hardware:
        for interface, claimed in component.claimed.items():
            joint = interface.rpartition("/")[0]
            joints[joint] = joints.get(joint, False) or claimed
    return joints


def _claiming_command(manager: ControlState) -> str:
    inactive = [c.name for c in manager.controllers if c.state == "inactive"]
    if inactive:
        return f"arm control switch_controllers --activate {inactive[0]}{manager.option}"
    return f"spawner position_controller{manager.option}, or another that commands the joints"


def check_commands(observation: GraphObservation) -> Diagnosis:
    """Check that a controller takes the published commands, and that they are not stale."""
    commands = observation.commands
    faults = [f for topic in commands if (f := _receiver_fault(topic) or _stamp_fault(topic))]
    if faults:
        return faults[0]
    received = [topic.name for topic in commands if topic.received]
    if received:
        return Diagnosis.ok("commands", f"commands arrive on {', '.join(received)}")
    waiting = [topic.name for topic in commands if topic.listeners]
    if not waiting:
        return Diagnosis.ok("commands", "no controller listens for commands on a topic")
    where = ", ".join(waiting)
    return Diagnosis.ok(
        "commands", f"none arrived on {where} meanwhile: the arm keeps its pose", SEND_ONE
    )


def _receiver_fault(topic: SetpointTopic) -> Diagnosis | None:
    if not topic.publishers:
        return None
    source = f"{topic.name} is published by {' and '.join(topic.publishers)}"
    if not topic.listeners:
        return Diagnosis.warning(
            "commands",
            f"{source}, but nobody subscribes: its controller is not loaded or has another name",
            "arm control list_controllers shows the names; spawner NAME loads one",
        )
    if topic.received and topic.controller and topic.state != "active":
        return Diagnosis.error(
            "commands",
            f"{source}, but {topic.controller} is {topic.state}",
            f"arm control switch_controllers --activate {topic.controller}",
        )
    return None


def _stamp_fault(topic: SetpointTopic) -> Diagnosis | None:
    if topic.ahead_s is None:
        return None
    source = f"the last command on {topic.name}, from {' or '.join(topic.publishers)},"
    clock = "stamp with the simulation's clock (use_sim_time:=true), or with 0 for now"
    if topic.ahead_s > TOO_FAR_AHEAD_S:
        return Diagnosis.error(
            "commands",
            f"{source} is stamped {topic.ahead_s:.0f} s ahead of the simulation's time",
            clock,
        )
    if -topic.ahead_s > topic.lasting_s:
        return Diagnosis.error(
            "commands",
            f"{source} is stale: it ended {-topic.ahead_s - topic.lasting_s:.1f} s ago",
            clock,
        )
    return None
