"""The hardware spawner as a program."""

from collections.abc import Callable
from typing import Any

import pytest
from std_msgs.msg import String


@pytest.fixture
def spawn_hardware(run) -> Callable[..., Any]:
    """Return a function that starts a hardware spawner."""
    return lambda *arguments: run("-m", "arm_control.spawner.hardware_spawner_node", *arguments)


def state(control: Any) -> str:
    (component,) = control.call("list_hardware_components").component
    return component.state.label


def test_it_configures_and_activates(control, spawn_hardware):
    output = spawn_hardware("HardwareInterface", "nothere", "--configure").succeed()
    assert "component 'HardwareInterface'" in output
    assert "Hardware now in state: lifecycle_msgs.msg.State(id=2, label='inactive')." in output
    assert "Hardware Component is not loaded - state can not be changed: nothere" in output
    assert "/controller_manager has HardwareInterface" in output
    assert state(control) == "inactive"
    spawn_hardware("HardwareInterface", "--activate", "-c", "/controller_manager").succeed()
    assert state(control) == "active"


# A manager without a robot offers no services yet


MOCK = "<hardware><plugin>mock_components/GenericSystem</plugin></hardware>"
ROBOT = (
    "<robot name='r'><link name='base_link'/><ros2_control name='Arm' type='system'>"
    f"{MOCK}<joint name='j0'><state_interface name='position'/></joint></ros2_control></robot>"
)


def test_spawners_wait_for_the_robot_description(
    run, spawn, spawn_hardware, client, control_of, latched
):
    namespace = ("--ros-args", "-r", "__ns:=/bare")
    type_name = "joint_state_broadcaster/JointStateBroadcaster"
    waiting = run(
        "-m", "arm_control.manager.ros2_control_node", *namespace, "-p", f"jsb.type:={type_name}"
    )
    waiting.wait_for_line("Waiting for data on 'robot_description' topic")
    spawners = [
        spawn("jsb", "--controller-manager-timeout", "0.5", *namespace),
        spawn_hardware("Arm", "--configure", "--controller-manager-timeout", "0.5", *namespace),
    ]
    for spawner in spawners:
        assert "Could not contact service /bare/controller_manager/list_" in spawner.fail()
    spawner = spawn("jsb", *namespace)
    spawner.wait_for_line("waiting for service /bare/controller_manager/list_controllers")
    description = client.node.create_publisher(String, "/bare/robot_description", latched)
    description.publish(String(data=ROBOT))
    spawner.succeed()
    assert control_of("/bare").states() == {"jsb": "active"}
    spawn_hardware("Arm", "--configure", *namespace).succeed()
    assert state(control_of("/bare")) == "inactive"
