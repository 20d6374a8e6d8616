"""A robot's description on other hardware, and the launch that runs it."""

import os

import pytest

from arm_control.hardware.info import parse_hardware_info
from arm_description.resources import resolve_uri
from arm_description.urdf.description_source import DescriptionSource, source_of, with_source
from arm_gazebo.errors import SimSettingsError
from arm_gazebo.launching.real_hardware import on_hardware
from launch_py.errors import UsageError
from launch_py.launch_description import expand_description
from launch_py.launch_description_sources import read_launch_file

BLOCK = """<ros2_control name="System" type="system">
<hardware><plugin>arm_gazebo/SimulatedHardware</plugin><param name="gain">2</param></hardware>
<joint name="j0"><command_interface name="position"/></joint></ros2_control>"""


def urdf(blocks: int = 1) -> str:
    return f'<robot name="arm"><link name="base"/>{BLOCK * blocks}</robot>'


def test_the_block_names_the_other_plugin_with_its_own_parameters(tmp_path):
    file = tmp_path / "arm.urdf"
    text = on_hardware(with_source(urdf(), file), "feetech", {"port": "/dev/ttyUSB1"})
    (info,) = parse_hardware_info(text)
    assert info.plugin == "arm_drivers/Feetech"
    assert info.parameters == {"port": "/dev/ttyUSB1"}
    assert [joint.name for joint in info.joints] == ["j0"]
    assert source_of(text) == DescriptionSource(file)


def test_any_plugin_is_taken():
    (info,) = parse_hardware_info(on_hardware(urdf(), "my_package/MyServos", {}))
    assert info.plugin == "my_package/MyServos"


def test_the_mycobot_loses_states_that_it_does_not_measure_and_has_its_own_rate():
    states = '<state_interface name="position"/><state_interface name="effort"/></joint>'
    (info,) = parse_hardware_info(
        on_hardware(urdf().replace("</joint>", states), "mycobot_280", {})
    )
    assert info.state_interface_names == ("j0/position",)
    assert info.read_write_rate_hz == 50


@pytest.mark.parametrize(
    ("hardware", "blocks", "sentence"),
    [
        ("fetech", 1, "no hardware 'fetech'; there are simulation, feetech,"),
        ("feetech", 2, "drives one <ros2_control> block; the description has 2"),
    ],
)
def test_what_cannot_be_is_refused(hardware, blocks, sentence):
    with pytest.raises(SimSettingsError) as caught:
        on_hardware(urdf(blocks), hardware, {})
    assert sentence in str(caught.value)


def plan_of(**arguments: str):
    file = resolve_uri("package://arm_gazebo/launch/arm_gazebo.launch.py")
    return expand_description(
        read_launch_file(file), arguments, {**os.environ, "PATH": "/bin"}, file
    )


def test_the_same_launch_starts_a_controller_manager_in_place_of_the_simulation():
    simulated = {step.name for step in plan_of(planning="true").processes}
    real = {step.name for step in plan_of(planning="true", hardware="feetech").processes}
    assert real - simulated == {"ros2_control_node", "spawner"}
    assert simulated - real == {"arm_gazebo_node"}


@pytest.mark.parametrize("given", [{"copies": "2"}, {"record_run": "run"}])
def test_what_needs_a_simulation_is_refused_with_a_real_arm(given):
    with pytest.raises(UsageError, match="hardware:= drives one real arm"):
        plan_of(hardware="feetech", **given)
