"""What the doctor finds about a running simulation, without its checks of the installation."""

import time
from collections.abc import Callable

import pytest

from arm_cli.doctor.diagnosis import Diagnosis
from arm_cli.doctor.ros_observer import observe
from arm_cli.doctor.verb import SIMULATION, examine_running
from arm_cli.ros.connection import connect

TIMEOUT_S = 120.0

Findings = dict[str, Diagnosis]


@pytest.fixture
def look() -> Callable[[Callable[[Findings], bool]], Findings]:
    """Return a function that looks again and again until the findings by check meet a condition.

    One look may be too short to find the simulation.
    """

    def ask(is_right: Callable[[Findings], bool]) -> Findings:
        deadline = time.monotonic() + TIMEOUT_S
        while True:
            with connect() as session:
                found = {finding.check: finding for finding in examine_running(observe(session))}
            if SIMULATION not in found and is_right(found):
                return found
            assert time.monotonic() < deadline, found

    return ask
