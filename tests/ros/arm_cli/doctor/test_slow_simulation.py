"""`arm doctor` beside a simulation with an impossible real-time factor."""

import json

import pytest

pytestmark = pytest.mark.ros


@pytest.fixture
def finding(launch_for_file, run_until):
    """Return the doctor's finding about the real-time factor, once it could measure it."""
    launch_for_file("camera:=none", "real_time_factor:=100000").wait_until_ready()

    def factor(text: str) -> dict[str, str]:
        findings = json.loads(text)["findings"]
        found = [f for f in findings if f["check"] == "real-time factor"]
        return found[0] if found else {"severity": "not looked at"}

    # The compilers are not what is looked at here. What is printed on stderr is not JSON.
    line = "env CC=true CXX=true arm doctor --json 2>/dev/null"
    return factor(run_until(line, lambda text: factor(text)["severity"] == "warning"))


def test_a_low_real_time_factor_is_reported(finding):
    assert " instead of 100000: the machine is too slow or too busy" in finding["sentence"]
    assert "end other programs" in finding["fix"]
