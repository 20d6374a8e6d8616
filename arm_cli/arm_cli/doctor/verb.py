"""`arm doctor`: finds out why the arm does not move or is not seen, and suggests fixes.

The checks run in the order of the chain from Python to the moving arm.
"""

import argparse
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict
from functools import partial

from arm_cli.arguments import JSON, Argument, verb
from arm_cli.doctor.diagnosis import Diagnosis, Severity
from arm_cli.doctor.installation import (
    check_compilers,
    check_interfaces,
    check_page_port,
    check_planning_interfaces,
    check_python,
    check_rclpy,
    check_rendering,
    check_shared_memory,
    check_wheels,
)
from arm_cli.doctor.network import (
    check_discovery,
    check_listening,
    check_ports,
    check_stopped,
    check_users,
)
from arm_cli.doctor.observation import GraphObservation
from arm_cli.doctor.running import (
    check_claims,
    check_clock,
    check_commands,
    check_controllers,
    check_description,
    check_hardware,
    check_joint_states,
    check_node_names,
    check_publishers,
    check_qos,
    check_real_time_factor,
)
from arm_cli.errors import ArmCliError, CommandUsageError
from arm_cli.names import this_domain
from arm_cli.output import colour, say_answer, say_coloured
from arm_cli.ros.connection import connect
from arm_node.printable import printable

SIMULATION = "simulation"
RUNNING_CHECKS: tuple[Callable[[GraphObservation], Diagnosis], ...] = (
    check_description,
    check_hardware,
    check_controllers,
    check_claims,
    check_clock,
    check_joint_states,
    check_real_time_factor,
    check_qos,
    check_publishers,
    check_node_names,
    check_commands,
)
EXIT_UNHEALTHY = 1
COLOURS = {Severity.OK: 92, Severity.WARNING: 93, Severity.ERROR: 91}
SEVERITY_WIDTH = max(map(len, Severity))


@verb(
    Argument(
        "--port",
        metavar="PORT",
        help="check the real arm on this serial port instead, such as /dev/ttyUSB0",
    ),
    JSON,
)
def doctor(options: argparse.Namespace) -> int:
    """Print each finding as soon as it is available; return 1 if there is an error."""
    findings: list[Diagnosis] = []
    for finding in _examine() if options.port is None else _examine_arm(options.port):
        findings.append(finding)
        if not options.json:
            say_coloured(_line(finding))
    healthy = is_healthy(findings)
    report = {"healthy": healthy, "findings": [asdict(finding) for finding in findings]}
    say_answer(options, report, [_summary(findings)])
    return 0 if healthy else EXIT_UNHEALTHY


def installation_checks(environ: Mapping[str, str]) -> tuple[Callable[[], Diagnosis], ...]:
    """Return the checks of the installation and the machine."""
    return (
        check_python,
        partial(check_rclpy, environ),
        check_wheels,
        partial(check_interfaces, environ),
        partial(check_planning_interfaces, environ),
        partial(check_compilers, environ),
        partial(check_rendering, environ),
        check_shared_memory,
        partial(check_discovery, environ),
        partial(check_ports, environ),
        partial(check_listening, environ),
        partial(check_stopped, environ),
        partial(check_users, environ),
        check_page_port,
    )


def examine_running(observation: GraphObservation) -> list[Diagnosis]:
    """Return the findings about a running simulation, or that none is running."""
    if observation.is_empty:
        return [
            Diagnosis.ok(
                SIMULATION,
                f"none is running on {this_domain()}",
                "start one: arm launch; if one is running, use the same ROS_DOMAIN_ID in both "
                "terminals, and ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET across hosts and containers",
            )
        ]
    return [check(observation) for check in RUNNING_CHECKS]


def is_healthy(findings: list[Diagnosis]) -> bool:
    """Return whether there is no error."""
    return all(finding.severity is not Severity.ERROR for finding in findings)


def _examine_arm(port: str) -> Iterator[Diagnosis]:
    # Imported here, because the other checks need no driver.
    from arm_cli.doctor.real_arm import examine_port

    yield from examine_port(port)


def _examine() -> Iterator[Diagnosis]:
    findings: list[Diagnosis] = []
    for check in installation_checks(dict(os.environ)):
        findings.append(check())
        yield findings[-1]
    if is_healthy(findings):
        yield from _examine_running()
    else:
        sentence = "not checked: the errors above may keep it from being seen"
        yield Diagnosis.warning(
            SIMULATION, sentence, "fix the errors above, then run arm doctor again"
        )


def _examine_running() -> list[Diagnosis]:
    try:
        with connect() as session:
            from arm_cli.doctor.ros_observer import observe

            return examine_running(observe(session))
    except CommandUsageError as error:
        return [Diagnosis.error(SIMULATION, str(error), _how_ros_starts(str(error)))]
    except ArmCliError as error:
        return [Diagnosis.error(SIMULATION, str(error), "start the simulation again")]


def _how_ros_starts(reason: str) -> str:
    if "log directory" in reason:
        return "set ROS_LOG_DIR to a folder that can be written to"
    if "peer" in reason:
        return "correct or unset ROS_STATIC_PEERS"
    return "correct the environment of this terminal, then run arm doctor again"


def _line(finding: Diagnosis) -> str:
    word = colour(COLOURS[finding.severity], f"{finding.severity:<{SEVERITY_WIDTH}}")
    line = f"{word}  {printable(f'{finding.check}: {finding.sentence}')}"
    return f"{line}\n{'':{SEVERITY_WIDTH}}  -> {printable(finding.fix)}" if finding.fix else line


def _summary(findings: list[Diagnosis]) -> str:
    counts = [
        f"{count} {severity}{'s' if count > 1 else ''}"
        for severity in (Severity.ERROR, Severity.WARNING)
        if (count := sum(finding.severity is severity for finding in findings))
    ]
    return ", ".join(counts) or "no problems found"
