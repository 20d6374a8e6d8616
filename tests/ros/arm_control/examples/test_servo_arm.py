"""The example package, installed by pip, launched and driven over ROS."""

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from lifecycle_msgs.msg import State
from sensor_msgs.msg import JointState

pytestmark = pytest.mark.timeout(600)

SOURCES = Path(__file__).parents[4] / "examples" / "servo_arm"
ACTIVE = 3
INSTALL_TIMEOUT_S = 150.0


@pytest.fixture(scope="module")
def installed(tmp_path_factory) -> Iterator[Path]:
    """Install the package into a folder of its own, which the module's processes look into."""
    folder = tmp_path_factory.mktemp("installation")
    sources, target = folder / "servo_arm", folder / "target"
    shutil.copytree(SOURCES, sources)
    command = [sys.executable, "-m", "pip", "install", "-q", "--no-deps"]
    subprocess.run(
        [*command, "--target", str(target), str(sources)], check=True, timeout=INSTALL_TIMEOUT_S
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", str(target), prepend=os.pathsep)
        patch.setenv("AMENT_PREFIX_PATH", str(target), prepend=os.pathsep)
        yield folder


@pytest.fixture(scope="module")
def launched(installed, run):
    """Return the running launch of the package."""
    program = run(
        *("-m", "arm_cli", "launch", "servo_arm", "servo_arm.launch.py"),
        f"device:={installed / 'port'}",
        "timeout:=5.0",  # A busy machine may hold the servos up.
    )
    program.wait_for_line("[launch] stop: ")
    return program


@pytest.fixture
def control(launched, client, control_of):
    return control_of("")


@pytest.fixture
def joint_states(client):
    return client.subscribe(JointState, "/joint_states")


def servos(control: Any) -> Any:
    (component,) = control.call("list_hardware_components").component
    return component


def wait_until_at(joint_states: Any, position: float) -> None:
    joint_states.wait_until(
        lambda messages: (
            messages and list(messages[-1].position) == pytest.approx([position] * 2, abs=0.02)
        ),
        f"both joints at {position}",
    )


def test_its_types_are_found(control):
    assert "servo_arm/PdController" in control.call("list_controller_types").types
    assert control.states() == {"joint_state_broadcaster": "active", "pd_controller": "active"}
    component = servos(control)
    assert component.plugin_name == "servo_arm/SerialServo"
    assert component.state.label == "active"


def test_its_parameters_take_effect_at_once(control, joint_states, set_parameter):
    assert set_parameter("/pd_controller", "target", 0.5).successful
    wait_until_at(joint_states, 0.5)


def test_servos_that_were_unplugged_are_used_again(
    control, client, launched, joint_states, set_parameter
):
    (fake,) = launched.processes("servo_arm.fake_servo")
    fake.kill()
    client.wait_until(lambda: servos(control).state.label == "unconfigured", "the servos are gone")
    client.wait_until(
        lambda: set(control.states().values()) == {"inactive"}, "their controllers stopped"
    )

    # The launcher restarts the fake servos, as if they were plugged in again.
    client.wait_until(
        lambda: (
            control.call(
                "set_hardware_component_state", name="Servos", target_state=State(id=ACTIVE)
            ).ok
        ),
        "the servos are there again",
    )
    assert control.switch(["joint_state_broadcaster", "pd_controller"]).ok
    assert set_parameter("/pd_controller", "target", -0.3).successful
    joint_states.clear()
    wait_until_at(joint_states, -0.3)
    assert "Traceback" not in launched.output
