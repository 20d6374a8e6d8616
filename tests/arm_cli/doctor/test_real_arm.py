"""The doctor's checks of a real arm, and `arm check --port`, on emulated arms."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from arm_cli.calibrate import joints_of
from arm_cli.check import compare_limits
from arm_cli.doctor.real_arm import examine_port
from arm_cli.errors import ArmCliError, CommandUsageError
from arm_description.resources import resolve_uri
from arm_sim.bench.feetech_servos import FeetechServos
from arm_sim.bench.mycobot_arm import EmulatedMyCobot
from arm_sim.bench.serial_device import EmulatedPort, SerialDevice


@pytest.fixture(autouse=True)
def few_rates(monkeypatch) -> None:
    """Each silent rate costs the whole time that a busy machine may need for a reply."""
    monkeypatch.setattr("arm_drivers.feetech.survey.BAUDS", (1_000_000, 115_200))


def findings(device: SerialDevice, folder: Path, timeout_s: float = 0.4) -> dict[str, str]:
    with EmulatedPort(device, folder / "port") as port:
        found = list(examine_port(str(port.path), timeout_s))
    return {each.check: f"{each.severity}: {each.sentence}" for each in found}


def test_servos_and_their_voltage_are_found(tmp_path):
    servos = FeetechServos(range(1, 4))
    servos.servos[2].memory[62] = 39
    found = findings(servos, tmp_path)
    assert found["device"] == (
        "ok: Feetech servos 1, 2, 3 answer at 1000000 baud: hardware:=feetech"
    )
    assert found["voltage"] == "error: servo 2 has 3.9 V; it needs 4 to 8 V"


def test_servos_at_another_baud_rate_are_found(tmp_path):
    found = findings(FeetechServos(range(1, 3), baud=115_200), tmp_path)
    assert found["device"].endswith("hardware:=feetech; start with hardware_args:='baud:=115200'")


def test_a_mycobot_is_found(tmp_path):
    found = findings(EmulatedMyCobot(), tmp_path)
    assert found["device"] == "ok: a myCobot answers at 115200 baud: hardware:=mycobot_280"


def test_nobody_behind_the_port_is_told(tmp_path):
    found = findings(FeetechServos([]), tmp_path, 0.01)
    assert "neither Feetech servos nor a myCobot answer" in found["device"]


def test_a_missing_port_is_told(tmp_path):
    (found,) = examine_port(str(tmp_path / "none"))
    assert f"no port {tmp_path / 'none'}; this machine has" in found.sentence


@pytest.fixture
def port(tmp_path) -> Iterator[str]:
    servos = FeetechServos(range(1, 5))
    servos.servos[2].store(9, 1000)
    servos.servos[2].store(11, 3000)
    with EmulatedPort(servos, tmp_path / "port") as plugged:
        yield str(plugged.path)


def test_limits_of_the_description_and_of_the_arm_are_compared(port):
    model = str(resolve_uri("package://arm_description/urdf/arm.urdf.xacro"))
    parameters = {"port": port, "reply_timeout": "1.0"}
    lines = list(compare_limits(model, (), "", "feetech", parameters))
    assert lines[0] == ("j0: the description has -2.570 to 2.570 rad, the arm -3.142 to 3.140 rad")
    assert lines[1].endswith("the arm -1.608 to 1.460 rad: it stops earlier")
    with pytest.raises(ArmCliError, match="holds no limits to compare"):
        list(compare_limits(model, (), "", "mock", {}))


def test_joints_have_the_servos_that_are_named_or_those_of_their_places():
    assert joints_of(["pan", "lift=6"]) == {"pan": 1, "lift": 6}
    for words in (["pan", "pan"], ["pan=2", "lift"], ["pan=x"], ["=1"]):
        with pytest.raises(CommandUsageError, match=r"twice|is not JOINT"):
            joints_of(words)
