"""A simulated robot with GPIOs, as a client of ros2_control sees it."""

import pytest
from control_msgs.msg import DynamicInterfaceGroupValues, InterfaceValue
from controller_manager_msgs.srv import ListHardwareComponents, ListHardwareInterfaces

ROBOT = """<robot name="cell"><link name="world"/><link name="slide"><inertial><mass value="1"/>
<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j0" type="prismatic"><parent link="world"/><child link="slide"/><axis xyz="1 0 0"/>
<limit lower="-1" upper="1" effort="10" velocity="1"/></joint>
<ros2_control name="cell" type="system">
<hardware><plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>
<joint name="j0"><command_interface name="position"/><state_interface name="position"/></joint>
<gpio name="lamp"><command_interface name="on"/>
<state_interface name="on"><param name="initial_value">1.0</param></state_interface></gpio>
<gpio name="gauge"><state_interface name="pressure"><param name="initial_value">2.5</param>
</state_interface></gpio>
</ros2_control></robot>"""
NAME = "gpio_controller"


@pytest.fixture(scope="module", autouse=True)
def simulation(simulate):
    simulate(
        {
            "arm_gazebo": {"robot_description": ROBOT, "spawn": NAME},
            "controller_manager": {NAME: {"type": "gpio_controllers/GpioCommandController"}},
            NAME: {
                "gpios": ["lamp", "gauge"],
                "command_interfaces": {"lamp": {"interfaces": ["on"]}},
            },
        }
    )


def test_commands_and_states_are_dynamic_interface_values(client):
    states = client.subscribe(DynamicInterfaceGroupValues, f"/{NAME}/gpio_states")
    (first, *_) = states.wait_for()
    assert list(first.interface_groups) == ["lamp", "gauge"]
    names = [list(each.interface_names) for each in first.interface_values]
    assert names == [["on"], ["pressure"]]
    assert [list(each.values) for each in first.interface_values] == [[1.0], [2.5]]

    commands = client.publisher(DynamicInterfaceGroupValues, f"/{NAME}/commands")
    off = InterfaceValue(interface_names=["on"], values=[0.0])
    commands.publish(DynamicInterfaceGroupValues(interface_groups=["lamp"], interface_values=[off]))
    last = states.wait_until(lambda m: m[-1].interface_values[0].values[0] == 0.0, "the lamp off")
    assert list(last[-1].interface_values[1].values) == [2.5]
    assert last[-1].header.stamp.sec < 1000


def test_they_are_listed_with_the_hardware(client):
    manager = "/controller_manager"
    listed = client.call(
        ListHardwareInterfaces,
        f"{manager}/list_hardware_interfaces",
        ListHardwareInterfaces.Request(),
    )
    claimed = {each.name: each.is_claimed for each in listed.command_interfaces}
    assert claimed == {"j0/position": False, "lamp/on": True}
    assert [each.name for each in listed.state_interfaces] == [
        "gauge/pressure",
        "j0/position",
        "lamp/on",
    ]
    (component,) = client.call(
        ListHardwareComponents,
        f"{manager}/list_hardware_components",
        ListHardwareComponents.Request(),
    ).component
    assert component.plugin_name == "gz_ros2_control/GazeboSimSystem"
    assert [each.name for each in component.command_interfaces] == ["j0/position", "lamp/on"]


def test_its_clock_is_that_of_the_simulation(client):
    for node in ("controller_manager", NAME, "cell"):
        assert client.get_parameter(f"/{node}", "use_sim_time"), node
    assert not client.node.get_subscriptions_info_by_topic("/clock")
