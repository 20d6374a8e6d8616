"""Small arms to build, and a bench to run them on."""

import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

from arm_control.hardware.info import parse_hardware_info
from arm_description.urdf.parser import parse_urdf
from arm_description.xacro.expansion import expand_xacro
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.model.builder import build_model
from arm_gazebo.model.built_model import BuiltModel
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics_timing import physics_timing
from arm_gazebo.robot.gazebo_tags import parse_gazebo_tags
from arm_gazebo.robot.part import BuildOptions
from arm_gazebo.sensors.camera import CameraSensor

ARM_XACRO = Path(__file__).parents[2] / "arm_description" / "urdf" / "arm.urdf.xacro"
INTERFACES = ("position", "velocity", "effort")


def ros2_control(
    joints: Sequence[str],
    commands: Sequence[str] = INTERFACES,
    states: Sequence[str] = INTERFACES,
    initial: float | None = None,
) -> str:
    """Return a <ros2_control> block with the same interfaces on every joint."""
    value = "" if initial is None else f'<param name="initial_value">{initial}</param>'
    each = "".join(f'<command_interface name="{name}"/>' for name in commands) + "".join(
        f'<state_interface name="{name}">{value if name == "position" else ""}</state_interface>'
        for name in states
    )
    blocks = "".join(f'<joint name="{joint}">{each}</joint>' for joint in joints)
    return (
        '<ros2_control name="sim" type="system"><hardware><plugin>arm_gazebo/SimulatedHardware'
        f"</plugin></hardware>{blocks}</ros2_control>"
    )


def link(name: str, mass: float = 0.0, size: float = 0.1, centre: str = "0 0 0") -> str:
    """Return a link: a solid cube with that side, or a mere frame without mass."""
    if not mass:
        return f'<link name="{name}"/>'
    moment = mass * size**2 / 6
    return (
        f'<link name="{name}"><inertial><origin xyz="{centre}"/><mass value="{mass}"/>'
        f'<inertia ixx="{moment}" iyy="{moment}" izz="{moment}" ixy="0" ixz="0" iyz="0"/>'
        "</inertial></link>"
    )


def joint(
    name: str,
    parent: str,
    child: str,
    kind: str = "revolute",
    xyz: str = "0 0 0",
    axis: str = "0 1 0",
    limit: str = 'lower="-3" upper="3" effort="20" velocity="3"',
    more: str = "",
) -> str:
    """Return a joint; an empty `limit` leaves the limits out."""
    bounds = f"<limit {limit}/>" if limit else ""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}"/><axis xyz="{axis}"/>{bounds}{more}</joint>'
    )


def robot(*parts: str) -> str:
    """Return a URDF of these parts."""
    return f'<robot name="bench">{"".join(parts)}</robot>'


def pendulum(more: str = "", limit: str = 'lower="-3" upper="3" effort="20" velocity="3"') -> str:
    """Return a URDF: 1 kg at 0.5 m from a horizontal axis 'j', pointing along x at zero."""
    return robot(
        link("base"),
        link("bob", 1.0, 0.05, "0.5 0 0"),
        joint("j", "base", "bob", xyz="0 0 2", limit=limit, more=more),
        ros2_control(["j"]),
    )


def wheel(mass_kg: float, limit: str) -> str:
    """Return a URDF: a wheel that turns by 'j' on a base, and nothing else."""
    return robot(
        link("base"),
        link("wheel", mass_kg),
        joint("j", "base", "wheel", "continuous", limit=limit),
        ros2_control(["j"]),
    )


def serial_arm(dof: int, mass_kg: float, reach_m: float, friction: float = 0.0) -> str:
    """Return a URDF of an arm like those in factories: strong shoulder, light fast wrist.

    Its efforts are twice what gravity asks for at most, and never under 20 rad/s2 by itself.
    """
    axes = ["0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0", "0 1 0"]
    lengths = np.array([0.15, 0.3, 0.25, 0.12, 0.1, 0.08, 0.05])[:dof]
    masses = np.array([3.7, 8.4, 2.3, 1.2, 1.2, 0.25, 0.15])[:dof]
    lengths, masses = lengths / lengths.sum() * reach_m, masses / masses.sum() * mass_kg
    parts, before, height = [link("base")], "base", 0.5
    for index in range(dof):
        beyond = masses[index:] @ np.cumsum(lengths[index:])
        inertia = masses[index:] @ np.cumsum(lengths[index:]) ** 2
        effort = max(2 * 9.81 * beyond, 20 * inertia)
        parts.append(link(f"l{index}", masses[index], lengths[index], f"0 0 {lengths[index] / 2}"))
        parts.append(
            joint(
                f"j{index}",
                before,
                f"l{index}",
                xyz=f"0 0 {height}",
                axis=axes[index],
                limit=f'lower="-2.9" upper="2.9" effort="{effort}" velocity="2"',
                more=f'<dynamics damping="0" friction="{friction * effort}"/>',
            )
        )
        before, height = f"l{index}", lengths[index]
    return robot(*parts, ros2_control([f"j{index}" for index in range(dof)]))


def arm(**arguments: str) -> str:
    """Return the URDF of this project's own arm."""
    return expand_xacro(ARM_XACRO, arguments)


def build(
    urdf: str, world: str | Path = "empty", cameras: Sequence[CameraSensor] = (), **options: object
) -> BuiltModel:
    """Build the model of a URDF with its hardware."""
    robot, hardware, tags = parse_urdf(urdf), parse_hardware_info(urdf), parse_gazebo_tags(urdf)
    return build_model(robot, hardware, cameras, world, BuildOptions(**options), tags)


class Bench:
    """A robot in a simulation, with its hardware, driven as a controller manager does."""

    def __init__(
        self,
        urdf: str,
        rate_hz: float = 100.0,
        world: str | Path = "empty",
        hold_joints: bool = True,
        proportional_gain: float = 0.0,
        **options: object,
    ) -> None:
        timing = physics_timing(rate_hz)
        self.rate_hz = rate_hz
        self.built = build(urdf, world, step_s=timing.step_s, **options)
        self.simulation = Physics(self.built, timing, hold_joints, proportional_gain)
        self.hardware = SimulatedHardware(self.simulation, parse_hardware_info(urdf)[0])
        self.states = np.full(len(self.hardware.state_interfaces), math.nan)
        self.commands = np.full(len(self.hardware.command_interfaces), math.nan)
        self.hardware.bind(self.states, self.commands)
        assert self.hardware.on_configure()
        assert self.hardware.on_activate()

    def names(self, interface: str) -> list[str]:
        return [n for n in self.hardware.command_interfaces if n.endswith(f"/{interface}")]

    def claim(self, interface: str = "position") -> None:
        """Claim an interface on every joint; `command` sets this one from now on."""
        names = self.names(interface)
        assert self.hardware.prepare_command_mode_switch(names, [])
        assert self.hardware.perform_command_mode_switch(names, [])
        self.claimed = [self.hardware.command_interfaces.index(name) for name in names]

    def release(self, interface: str = "position") -> None:
        assert self.hardware.perform_command_mode_switch([], self.names(interface))

    def command(self, *values: float) -> None:
        self.commands[self.claimed] = values

    @property
    def commanded(self) -> np.ndarray:
        return self.commands[self.claimed]

    def tick(self) -> None:
        period_s = 1 / self.rate_hz
        self.hardware.write(self.simulation.time_s, period_s)
        self.simulation.advance()
        self.hardware.read(self.simulation.time_s, period_s)

    def run(self, seconds: float) -> np.ndarray:
        """Run and return the positions after every tick, shape (ticks, joints)."""
        rows = []
        for _ in range(round(seconds * self.rate_hz)):
            self.tick()
            rows.append(self.state("position"))
        return np.array(rows)

    def state(self, interface: str) -> np.ndarray:
        """Return a copy of one kind of state of every joint that has it."""
        names = self.hardware.state_interfaces
        return self.states[[i for i, name in enumerate(names) if name.endswith(f"/{interface}")]]


SEVERAL_CONTROLS = """<mujoco><worldbody>
  <body name="door" pos="3 0 1"><joint name="dj" axis="0 0 1"/><geom size="0.1" mass="1"/></body>
  <body name="head" pos="4 0 1"><joint name="hj" type="ball"/><geom size="0.1" mass="1"/></body>
</worldbody><actuator>
  <pid name="p" joint="dj" kp="10" kv="1"/>
  <orientation name="o" joint="hj" kp="10" kv="1"/>
  <pid name="i" joint="dj" kp="1" kv="1" ki="1"/>
</actuator></mujoco>"""


@pytest.fixture
def several_controls(tmp_path: Path) -> Path:
    """Return a world with actuators that have several controls each, 7 in all, at rest."""
    file = tmp_path / "several_controls.xml"
    file.write_text(SEVERAL_CONTROLS)
    return file


class Parts:
    """The parts from which the tests of this folder build URDFs."""

    arm = staticmethod(arm)
    build = staticmethod(build)
    joint = staticmethod(joint)
    link = staticmethod(link)
    pendulum = staticmethod(pendulum)
    wheel = staticmethod(wheel)
    robot = staticmethod(robot)
    ros2_control = staticmethod(ros2_control)
    serial_arm = staticmethod(serial_arm)


@pytest.fixture(scope="session")
def parts() -> type[Parts]:
    return Parts


@pytest.fixture
def bench() -> Callable[..., Bench]:
    return Bench
