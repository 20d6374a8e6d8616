"""The recipe for a controller: one that moves all its joints to one number, from a topic."""

import subprocess

import pytest
from checkout import TIMEOUT_S, Checkout

DOCSTRING = '"""Moves several joints to the same position."""\n'

CONTROLLER = '''\
"""unison_controller/UnisonController: moves several joints to the same position."""

from dataclasses import dataclass

from arm_control.controllers.controller import Controller, InterfaceConfiguration, ReturnType
from arm_control.parameters import parameter


@dataclass(frozen=True, slots=True)
class UnisonParameters:
    """Parameters of UnisonController."""

    joints: tuple[str, ...] = parameter((), "Joints to move", at_configuration=True)


class UnisonController(Controller[UnisonParameters]):
    """Writes the latest target to the position interfaces of its joints."""

    parameters_type = UnisonParameters
    adapter = "arm_control.controllers.unison.ros:UnisonAdapter"
    target: float | None = None

    def command_interface_configuration(self) -> InterfaceConfiguration:
        """Claim the positions of the joints."""
        return InterfaceConfiguration.individual(f"{j}/position" for j in self.parameters.joints)

    def state_interface_configuration(self) -> InterfaceConfiguration:
        """Read nothing."""
        return InterfaceConfiguration.none()

    def update(self, time_s: float, period_s: float) -> ReturnType:
        """Write the target."""
        if self.target is not None:
            self.commands.write(self.target)
        return ReturnType.OK
'''

ADAPTER = '''\
"""The ROS half of UnisonController: the topic of its target."""

from std_msgs.msg import Float64

from arm_control.controllers.ros_adapter import ControllerAdapter
from arm_control.controllers.unison.controller import UnisonController, UnisonParameters


class UnisonAdapter(ControllerAdapter[UnisonController]):
    """Hands each std_msgs/msg/Float64 of ~/target to the core."""

    def on_configure(self, parameters: UnisonParameters) -> None:
        """Subscribe."""
        self.subscribe(Float64, "~/target", self._take)

    def _take(self, message: Float64) -> None:
        self.controller.target = message.data
'''

WITHOUT_ROS = """\
from arm_control import ControllerContext, ControllerManager, SwitchRequest
from arm_control.manager.registry import controller_class
from arm_control.testing import fake_hardware

hardware = fake_hardware(("j0", "j1"), command_interfaces=("position",))
manager = ControllerManager([hardware], 100)
manager.bring_up()
controller = controller_class("unison_controller/UnisonController")(ControllerContext("u", 100))
manager.load_controller(controller, "u", ())
manager.configure_controller("u", controller.build_parameters({"joints": ("j0", "j1")}), 100)
assert manager.switch_controller(SwitchRequest(activate=("u",))).ok
controller.target = 0.5
manager.update(0.0, 0.01)
print(hardware.commands.tolist())
assert "rclpy" not in sys.modules
"""

# The launch file's spawner starts a controller of this name.
PARAMETERS = """\
controller_manager:
  ros__parameters:
    update_rate: 100
    joint_state_broadcaster:
      type: joint_state_broadcaster/JointStateBroadcaster
    position_controller:
      type: unison_controller/UnisonController
position_controller:
  ros__parameters:
    joints: [j0, j1, j2, j3]
"""


@pytest.fixture
def checkout(tmp_path):
    checkout = Checkout(tmp_path, "A controller", NAME="unison")
    folder = "arm_control/arm_control/controllers/unison"
    checkout.write(f"{folder}/__init__.py", DOCSTRING)
    checkout.write(f"{folder}/controller.py", CONTROLLER)
    checkout.write(f"{folder}/ros.py", ADAPTER)
    checkout.insert(
        "arm_control/arm_control/manager/registry.py",
        (
            "_CONTROLLERS = {\n",
            '_CONTROLLERS = {\n    "unison_controller/UnisonController": '
            'f"{_BUILT_IN}.unison.controller:UnisonController",\n',
        ),
    )
    return checkout


def test_a_controller_is_added_through_the_files_of_its_recipe(checkout):
    assert checkout.run(WITHOUT_ROS) == "[0.5, 0.5]\n"


@pytest.mark.ros
def test_its_topic_moves_the_joints_of_a_running_manager(checkout, tmp_path):
    file = tmp_path / "controllers.yaml"
    file.write_text(PARAMETERS)
    script = "runpy.run_module('arm_cli', run_name='__main__', alter_sys=True)"
    words = ("launch", "arm_control", "arm_mock.launch.py", f"controllers:={file}")
    launch = subprocess.Popen(
        checkout.command(script, *words),
        env=checkout.environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    try:
        assert launch.stdout is not None
        printed = []
        for line in launch.stdout:
            printed.append(line)
            if line.startswith("ready"):
                break
        assert printed[-1].startswith("ready"), "".join(printed)
        checkout.run_module(
            *("arm_cli", "topic", "pub", "--once", "/position_controller/target"),
            *("std_msgs/msg/Float64", "data: 0.5"),
        )
        moved = ("--filter", "list(m) == [0.5] * 4")
        echo = ("topic", "echo", "/joint_states", "--once", "--field", "position", *moved)
        assert "[0.5, 0.5, 0.5, 0.5]" in checkout.run_module("arm_cli", *echo)
    finally:
        launch.terminate()
        launch.communicate(timeout=TIMEOUT_S)
