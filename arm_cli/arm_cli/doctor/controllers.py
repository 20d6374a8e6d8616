"""Checks of a running simulation's controllers and hardware."""

from arm_cli.doctor.diagnosis import Diagnosis
from arm_cli.doctor.observation import ControlState, GraphObservation, SetpointTopic

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
