"""All checks, in the order in which the chain from Python to the moving arm is built."""

from collections.abc import Callable, Mapping

from arm_cli.doctor.check import Check
from arm_cli.doctor.client_library import ClientLibrary
from arm_cli.doctor.clock_advancing import ClockAdvancing
from arm_cli.doctor.commands_taken import CommandsTaken
from arm_cli.doctor.compiler import Compiler
from arm_cli.doctor.controllers_active import ControllersActive
from arm_cli.doctor.description_published import DescriptionPublished
from arm_cli.doctor.discovery import Discovery
from arm_cli.doctor.finding import Finding, Severity
from arm_cli.doctor.hardware_active import HardwareActive
from arm_cli.doctor.interface_packages import InterfacePackages
from arm_cli.doctor.joint_states_come import JointStatesCome
from arm_cli.doctor.joints_claimed import JointsClaimed
from arm_cli.doctor.observation import Observation
from arm_cli.doctor.page_port import PagePort
from arm_cli.doctor.ports import Ports
from arm_cli.doctor.python_version import PythonVersion
from arm_cli.doctor.qos_matches import QosMatches
from arm_cli.doctor.real_time_factor import RealTimeFactor
from arm_cli.doctor.rendering import Rendering
from arm_cli.doctor.shared_memory import SharedMemory
from arm_cli.doctor.single_publishers import SinglePublishers
from arm_cli.doctor.wheels import Wheels
from arm_cli.names import this_domain

SIMULATION = "simulation"

RUNNING_CHECKS: tuple[Callable[[Observation], Check], ...] = (
    DescriptionPublished,
    HardwareActive,
    ControllersActive,
    JointsClaimed,
    ClockAdvancing,
    JointStatesCome,
    RealTimeFactor,
    QosMatches,
    SinglePublishers,
    CommandsTaken,
)


def installation_checks(environ: Mapping[str, str]) -> tuple[Check, ...]:
    """Return the checks of what must be right before anything runs."""
    return (
        PythonVersion(),
        ClientLibrary(environ),
        Wheels(),
        InterfacePackages(environ),
        Compiler(environ),
        Rendering(environ),
        SharedMemory(),
        Discovery(environ),
        Ports(environ),
        PagePort(),
    )


def examine_running(observation: Observation) -> list[Finding]:
    """Return what the checks of a running simulation find, or that none runs."""
    if observation.is_empty:
        return [
            Finding.ok(
                SIMULATION,
                f"none runs on {this_domain()}",
                "start one: arm launch; where one runs, give both terminals one ROS_DOMAIN_ID, "
                "and export ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET for other hosts and containers",
            )
        ]
    return [make(observation).examine() for make in RUNNING_CHECKS]


def is_healthy(findings: list[Finding]) -> bool:
    """Return whether there is no error."""
    return all(finding.severity is not Severity.ERROR for finding in findings)
