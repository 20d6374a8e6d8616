"""Whatever interfaces each joint declares, and in whatever order: states and commands fit."""

import math
from types import SimpleNamespace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from arm_control.hardware.info import HardwareInfo, InterfaceInfo, JointInfo, parse_hardware_info
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.hardware.simulated_sensors import SensorStates
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics_timing import physics_timing

KINDS = ("position", "velocity", "effort")
COMMANDS = (*KINDS, "max_effort")
LIMIT = 'lower="-3" upper="3" effort="20" velocity="6"'


@st.composite
def declarations(draw):
    """Draw for each joint, in any order, its commands and its states, in any order."""
    count = draw(st.integers(1, 5))
    some = st.lists(st.sampled_from(KINDS), unique=True, max_size=len(KINDS))
    commands = st.lists(st.sampled_from(COMMANDS), unique=True, max_size=len(COMMANDS))
    order = draw(st.permutations([f"j{index}" for index in range(count)]))
    return [(name, draw(commands), draw(some)) for name in order]


def description(parts, declared):
    """Return turntables side by side on one base, each with its own interfaces."""
    names = sorted(name for name, _, _ in declared)
    bodies = [parts.link(f"l{index}", 1.0) for index in range(len(names))]
    joints = [
        parts.joint(name, "base", f"l{index}", xyz=f"{index} 0 1", axis="0 0 1", limit=LIMIT)
        for index, name in enumerate(names)
    ]
    blocks = "".join(
        f'<joint name="{name}">'
        + "".join(f'<command_interface name="{kind}"/>' for kind in commands)
        + "".join(f'<state_interface name="{kind}"/>' for kind in states)
        + "</joint>"
        for name, commands, states in declared
    )
    control = (
        '<ros2_control name="sim" type="system"><hardware><plugin>arm_gazebo/SimulatedHardware'
        f"</plugin></hardware>{blocks}</ros2_control>"
    )
    return parts.robot(parts.link("base"), *bodies, *joints, control)


class Driven:
    """Hardware whose arrays are strided parts of larger ones, as a manager may hand them out."""

    def __init__(self, simulation, info):
        self.simulation = simulation
        self.hardware = SimulatedHardware(simulation, info)
        states, commands = self.hardware.state_interfaces, self.hardware.command_interfaces
        self.states = np.full(2 * len(states), math.nan)[::2]
        self.commands = np.full(2 * len(commands), math.nan)[::2]
        self.hardware.bind(self.states, self.commands)
        assert self.hardware.on_configure()
        assert self.hardware.on_activate()

    def run(self, ticks):
        for _ in range(ticks):
            self.hardware.write(self.simulation.time_s, 0.01)
            self.simulation.advance()
            self.hardware.read(self.simulation.time_s, 0.01)

    def assert_states_are_the_physics(self):
        data, joints = self.simulation.data, self.simulation.built.joints
        for name, value in zip(self.hardware.state_interfaces, self.states, strict=True):
            joint, kind = joints[name.rpartition("/")[0]], name.rpartition("/")[2]
            expected = {
                "position": data.qpos[joint.qpos_address],
                "velocity": data.qvel[joint.dof_address],
                "effort": data.qfrc_actuator[joint.dof_address],
            }[kind]
            assert value == expected, (name, value, expected)


@settings(max_examples=60)
@given(declared=declarations())
def test_states_are_the_physics_and_commands_reach_their_joint(parts, declared):
    urdf = description(parts, declared)
    timing = physics_timing(100.0)
    simulation = Physics(parts.build(urdf, step_s=timing.step_s), timing)
    arm = Driven(simulation, parse_hardware_info(urdf)[0])
    hardware = arm.hardware
    assert hardware.state_interfaces == tuple(f"{n}/{s}" for n, _, kinds in declared for s in kinds)

    claimed = {
        f"{name}/{kind}": (name, kind)
        for name, commands, _ in declared
        for kind in commands[:1]
        if kind in ("position", "velocity")
    }
    assert hardware.perform_command_mode_switch(tuple(claimed), ())
    wanted = {}
    for number, interface in enumerate(claimed, 1):
        wanted[interface] = 0.2 * number
        arm.commands[hardware.command_interfaces.index(interface)] = wanted[interface]
    arm.run(3)
    arm.assert_states_are_the_physics()
    arm.run(120)
    arm.assert_states_are_the_physics()

    joints, physics = simulation.built.joints, simulation.data
    moved = {name: interface for interface, (name, _) in claimed.items()}
    for name, joint in joints.items():
        position, velocity = physics.qpos[joint.qpos_address], physics.qvel[joint.dof_address]
        interface = moved.get(name)
        if interface is None:
            assert abs(position) < 1e-3, name
        elif interface.endswith("/position"):
            assert abs(position - wanted[interface]) < 1e-2, interface
        else:
            assert abs(velocity - wanted[interface]) < 1e-2, interface


class Reader:
    """Replaces a simulated sensor: channel k of sensor n reads 10 n + k."""

    def __init__(self, number, channels):
        self.description = SimpleNamespace(name=f"s{number}", channels=channels)
        self._reading = 10.0 * number + np.arange(len(channels))

    def read(self):
        return self._reading


@given(
    shown=st.lists(st.lists(st.sampled_from("abcdef"), unique=True), max_size=4),
    absent=st.sets(st.integers(0, 3)),
)
def test_sensor_states_come_from_their_own_channel(shown, absent):
    parts = tuple(
        JointInfo(f"s{number}", state_interfaces=tuple(map(InterfaceInfo, channels)))
        for number, channels in enumerate(shown)
    )
    info = HardwareInfo("sim", "system", "p", sensors=parts)
    readers = [Reader(n, tuple("fedcba")) for n in range(len(shown)) if n not in absent]
    sensors = SensorStates(info, readers[::-1])
    states = np.full(2 * len(sensors.names), math.nan)[::2]
    sensors.fill(states)
    expected = {
        f"s{number}/{channel}": 10.0 * number + "fedcba".index(channel)
        for number, channels in enumerate(shown)
        if number not in absent
        for channel in channels
    }
    assert dict(zip(sensors.names, states.tolist(), strict=True)) == expected
