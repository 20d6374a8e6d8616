"""The launch of the arm on emulated servos: it moves, loses its plug, and is taken up again."""

from collections.abc import Iterator
from typing import Any

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from lifecycle_msgs.msg import State
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

from arm_sim.bench.feetech_servos import FeetechServos
from arm_sim.bench.serial_device import EmulatedPort

pytestmark = pytest.mark.timeout(600)
ACTIVE = 3


@pytest.fixture
def port(tmp_path) -> Iterator[EmulatedPort]:
    with EmulatedPort(FeetechServos(range(1, 5)), tmp_path / "servos") as plugged:
        yield plugged


def test_it_moves_and_is_taken_up_again_after_its_plug_was_pulled(port, run, client, control_of):
    launched = run(
        *("-m", "arm_cli", "launch", "arm_gazebo", "arm_gazebo.launch.py"),
        *("hardware:=feetech", f"port:={port.path}", "controller_node:=false"),
        # A busy machine may hold the emulated servos up.
        "hardware_args:=reply_timeout:=0.2 max_missed:=50",
    )
    launched.wait_for_line("[launch] stop: ")
    assert "never on a real arm" in launched.output
    control = control_of("")
    states = client.subscribe(JointState, "/joint_states")
    reports = client.subscribe(DiagnosticArray, "/diagnostics")
    commands = client.publisher(Float64MultiArray, "/position_controller/commands")

    def move_to(position: float) -> None:
        wanted = pytest.approx([position] * 4, abs=0.02)

        def are_there() -> bool:
            # The controller's subscription is best effort: it may miss a command.
            commands.publish(Float64MultiArray(data=[position] * 4))
            return bool(states.messages) and list(states.messages[-1].position) == wanted

        client.wait_until(are_there, f"all joints at {position}")

    def component() -> Any:
        (only,) = control.call("list_hardware_components").component
        return only

    move_to(0.3)
    port.unplug()
    client.wait_until(lambda: component().state.label == "unconfigured", "the plug is missed")
    client.wait_until(
        lambda: set(control.states().values()) == {"inactive"}, "its controllers stopped"
    )
    launched.wait_for_line(f"port {port.path} has gone")
    reports.clear()
    told = f"{component().name}: port {port.path} has gone"
    reports.wait_until(
        lambda messages: any(told in status.message for m in messages for status in m.status),
        "/diagnostics tells it",
    )

    port.plug()
    name, target = component().name, State(id=ACTIVE)
    assert control.call("set_hardware_component_state", name=name, target_state=target).ok
    assert control.switch(["joint_state_broadcaster", "position_controller"]).ok
    states.clear()
    move_to(-0.2)
    assert "Traceback" not in launched.output
