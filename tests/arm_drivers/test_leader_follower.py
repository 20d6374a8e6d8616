"""One arm that follows another: the controller on fake hardware, and the description of both."""

import numpy as np
import pytest

from arm_control import ControllerContext, ControllerError, ControllerManager, SwitchRequest
from arm_control.hardware.info import parse_hardware_info
from arm_control.testing import fake_hardware
from arm_description.urdf.parser import parse_urdf
from arm_drivers.leader_follower import LeaderFollowerController
from arm_gazebo.launching.leader_follower import pair_arms

PARAMETERS = {
    "leader_joints": ("l0", "l1"),
    "follower_joints": ("f0", "f1"),
    "approach_velocity": 0.5,
}


@pytest.fixture
def arms():
    return fake_hardware(
        ("l0", "l1", "f0", "f1"), command_interfaces=("position",), state_interfaces=("position",)
    )


@pytest.fixture
def manager(arms):
    manager = ControllerManager([arms], 100)
    manager.bring_up()
    controller = LeaderFollowerController(ControllerContext("follow", 100))
    manager.load_controller(controller, "arm_drivers/LeaderFollowerController", ())
    manager.configure_controller("follow", controller.build_parameters(PARAMETERS), 100)
    arms.states[:] = (1.0, -0.2, 0.0, 0.0)
    assert manager.switch_controller(SwitchRequest(activate=("follow",))).ok
    return manager


def test_the_follower_comes_slowly_and_then_follows_in_the_same_cycle(manager, arms):
    arms.states[:2] = (0.2, -0.2)
    commands = []
    for _ in range(100):
        manager.update(0.0, 0.01)
        commands.append(arms.commands[2:].copy())
    assert commands[0] == pytest.approx([0.005, -0.005])
    assert np.abs(np.diff(commands, axis=0)).max() <= 0.06
    assert commands[-1] == pytest.approx([0.2, -0.2])
    arms.states[:2] = (0.7, 0.1)
    manager.update(0.0, 0.01)
    assert arms.commands[2:] == pytest.approx([0.7, 0.1])


def test_as_many_joints_must_follow_as_lead():
    controller = LeaderFollowerController(ControllerContext("follow", 100))
    unequal = controller.build_parameters({**PARAMETERS, "leader_joints": ("l0",)})
    with pytest.raises(ControllerError, match="they are 1 and 2"):
        controller.on_configure(unequal)


def test_two_arms_have_one_description():
    urdf = """<robot name="arm"><link name="base"/><link name="tip"/>
    <joint name="j0" type="revolute"><parent link="base"/><child link="tip"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
    <ros2_control name="System" type="system"><hardware><plugin>x/Y</plugin></hardware>
    <joint name="j0"><command_interface name="position"/></joint></ros2_control></robot>"""
    ports = {"leader": {"port": "/dev/a", "passive": "true"}, "follower": {"port": "/dev/b"}}
    pair = pair_arms(urdf, "feetech", ports)
    parameters = {info.name: info.parameters for info in parse_hardware_info(pair.description)}
    assert parameters == ports
    links = {link.name for link in parse_urdf(pair.description).links}
    assert links == {"world", *(f"{a}_{b}" for a in ports for b in ("base", "tip"))}
    assert pair.controllers["leader_follower"]["ros__parameters"] == {
        "leader_joints": ["leader_j0"],
        "follower_joints": ["follower_j0"],
    }
