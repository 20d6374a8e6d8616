"""A simulation waits for a controller in another process, and both repeat to the last bit."""

import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import yaml
from run_python import run_python
from simulated import PAUSED, PLAYING, Simulated

from arm_description.resources import resolve_uri
from arm_description.xacro.expansion import expand_xacro

PARTNER = Path(__file__).with_name("lock_step_partner.py")
TIMEOUT_S = 120.0
LAST = 400


@pytest.fixture(scope="module")
def start(tmp_path_factory) -> Iterator[Callable[[], Path]]:
    """Start a simulation in lock-step with /partner, as fast as possible; return its log."""
    arm = str(resolve_uri("package://arm_description/urdf/arm.urdf.xacro"))
    settings = {
        "robot_description": expand_xacro(arm, {"camera": "none"}),
        "spawn": "joint_state_broadcaster,mover",
        "real_time_factor": 0,
        "lockstep": "/partner",
        "lockstep_timeout": 30,
    }
    parameters = {
        "arm_gazebo": settings,
        "controller_manager": {
            "joint_state_broadcaster": {"type": "joint_state_broadcaster/JointStateBroadcaster"},
            "mover": {"type": "position_controllers/JointGroupPositionController"},
        },
        "mover": {"joints": ["j0", "j1", "j2", "j3"]},
    }
    folder = tmp_path_factory.mktemp("lock_step")
    path = folder / "parameters.yaml"
    path.write_text(yaml.safe_dump({n: {"ros__parameters": v} for n, v in parameters.items()}))
    running: list[subprocess.Popen] = []

    def end() -> None:
        while running:
            process = running.pop()
            process.send_signal(signal.SIGINT)
            try:
                assert process.wait(60.0) == 0
            finally:
                process.kill()

    def run() -> Path:
        end()
        log = folder / f"log_{len(list(folder.iterdir()))}"
        arguments = ["-m", "arm_gazebo.arm_gazebo_node", "--ros-args", "--params-file", str(path)]
        with log.open("w") as file:
            running.append(subprocess.Popen([sys.executable, *arguments], stderr=file))
        return log

    yield run
    end()


def partner_until(last: int) -> list[tuple[int, tuple[str, ...]]]:
    """Run a partner; return the control periods that it saw, each with the joints' positions."""
    out = run_python(str(PARTNER), str(last), check=True).stdout
    # Fast DDS prints its complaints to stdout, on a busy machine.
    lines = [line.split() for line in out.splitlines() if line[:1].isdigit()]
    return [(int(period), tuple(positions)) for period, *positions in lines]


Seen = list[tuple[int, tuple[str, ...]]]


@pytest.fixture(scope="module")
def runs(start) -> tuple[Seen, Seen, Path]:
    """What partners saw in two runs, and the log of the second simulation, which is still there."""
    start()
    first = partner_until(LAST)
    log = start()
    return first, partner_until(LAST), log


def test_the_partner_sees_every_control_period(runs):
    assert [period for period, _ in runs[0]] == list(range(1, LAST + 1))


def test_the_run_repeats_to_the_last_bit(runs):
    assert runs[0] == runs[1]
    assert len({positions for _, positions in runs[0]}) > LAST // 2


def test_a_silent_partner_pauses_the_run_and_another_one_continues_it(runs, client):
    simulation = Simulated(client)
    assert simulation.set(lockstep_timeout=0.2) == ""
    client.wait_until(lambda: simulation.state() == PAUSED, "the pause")
    said = f"lock-step: no answer from /partner for the time {LAST / 100:.3f} s within"
    client.wait_until(lambda: said in runs[2].read_text(), f"the log: {said}")
    assert simulation.set(lockstep_timeout=60.0) == ""
    simulation.go_to(PLAYING)
    seen = partner_until(LAST + 50)
    assert [period for period, _ in seen] == list(range(LAST + 1, LAST + 51))
