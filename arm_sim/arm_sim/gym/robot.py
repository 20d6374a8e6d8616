"""A simulated robot for environments: the joints with one command interface, one controller."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from os import fspath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from arm_control.hardware.info import parse_hardware_info
from arm_gazebo.launching.robot_setup import set_up_robot
from arm_gazebo.robot.actuation import RobotJoint
from arm_gazebo.world.entity_motion import EntityMotions
from arm_sim.errors import CallError, UnknownNameError
from arm_sim.robots import NAMED_ROBOTS, AnyPath
from arm_sim.set_up import assignments
from arm_sim.simulation import Simulation

Array = NDArray[np.float64]

CONTROLLER = "gym_controller"
FORWARD = "forward_command_controller/ForwardCommandController"
WHOLE_WITHIN = 1e-6
"""How far the time of an action may be from a whole number of control periods, in periods."""


@dataclass(frozen=True, slots=True)
class RobotOptions:
    """How an environment sets up its robot.

    Attributes:
        description: see `Simulation`.
        joints: the joints that actions command; None for all that have the interface.
        decision_s: simulated time of one action, a whole number of control periods.
        control_rate_hz: control rate.
        simulation: further arguments of `Simulation`, such as `world`.
    """

    description: AnyPath
    joints: Sequence[str] | None
    decision_s: float
    control_rate_hz: int
    simulation: Mapping[str, Any]

    def periods(self) -> int:
        """Return the control periods of one action.

        Raises:
            CallError: its time is not a whole number of control periods.
        """
        periods = self.decision_s * self.control_rate_hz
        if round(periods) < 1 or abs(periods - round(periods)) > WHOLE_WITHIN:
            raise CallError(
                f"decision_s is {self.decision_s:g} s, which is not a whole number of control "
                f"periods of {1.0 / self.control_rate_hz:g} s"
            )
        return round(periods)


class CommandedRobot:
    """A simulation whose joints follow one forwarding controller.

    Attributes:
        simulation: the simulation.
        joints: the commanded joints.
        drives: indices of their drives in the simulation.
        periods: control periods of one action.
        lower: lowest positions of the joints, shape (n,).
        upper: highest positions of the joints, shape (n,).
    """

    def __init__(self, options: RobotOptions, interface: str) -> None:
        """Build it.

        Raises:
            CallError: a joint does not have the command interface.
        """
        self.periods = options.periods()
        names = _commanded(options, interface)
        self.simulation = Simulation(
            options.description,
            controllers=_controllers(names, interface, options.control_rate_hz),
            **options.simulation,
        )
        self._physics = physics = self.simulation.parts.physics
        self.joints: tuple[RobotJoint, ...] = tuple(physics.built.joints[name] for name in names)
        driven = [joint.name for joint in physics.servo.joints]
        self.drives = [driven.index(name) for name in names]
        self.lower = np.array([joint.lower for joint in self.joints])
        self.upper = np.array([joint.upper for joint in self.joints])
        self._motions: EntityMotions | None = None
        self._bodies: dict[str, int] = {}
        self._bodies_of = physics.model

    def restart(self) -> None:
        """Return robot and world to their start, with the clock at 0 and without a command."""
        controllers = self.simulation.controllers
        controllers.switch(deactivate=[CONTROLLER])
        self._physics.reset()
        controllers.switch(activate=[CONTROLLER])

    def command(self, values: Sequence[float]) -> None:
        """Command the joints from the next control period on."""
        self.simulation[CONTROLLER].command(values)

    def body(self, name: str) -> int:
        """Return the index of the body of a link, or of a thing in the world.

        Raises:
            UnknownNameError: there is no such body.
        """
        model = self._physics.model
        if model is not self._bodies_of:
            self._bodies, self._bodies_of = {}, model
        if name not in self._bodies:
            try:
                self._bodies[name] = int(model.body(name).id)
            except KeyError:
                names = [model.body(index).name for index in range(1, model.nbody)]
                raise UnknownNameError(f"no link '{name}'; there are {', '.join(names)}") from None
        return self._bodies[name]

    def point_at(self, link: str, positions: Array) -> Array:
        """Return where a link would be with the joints at positions, shape (3,)."""
        self.body(link)
        physics = self._physics
        if self._motions is None:
            self._motions = EntityMotions(physics.model)
        qpos = physics.built.qpos.copy()
        qpos[[joint.qpos_address for joint in self.joints]] = positions
        self._motions.take(replace(physics.state(), qpos=qpos))
        return self._motions.pose(link)[:3, 3].copy()


def _commanded(options: RobotOptions, interface: str) -> list[str]:
    """Return the names of the joints that actions command."""
    named = NAMED_ROBOTS.get(fspath(options.description))
    model = named.model if named else fspath(options.description)
    given = dict(named.arguments) if named else {}
    given |= options.simulation.get("arguments") or {}
    path = options.simulation.get("package_path") or ()
    setup = set_up_robot(
        model, assignments(given), package_path=os.pathsep.join(fspath(one) for one in path)
    )
    able = [
        part.name
        for component in parse_hardware_info(setup.description)
        for part in component.joints
        if part.mimic is None and any(one.name == interface for one in part.command_interfaces)
    ]
    asked = able if options.joints is None else list(options.joints)
    unable = next((name for name in asked if name not in able), None)
    if unable is not None or not asked:
        whose = "the robot has no joint" if unable is None else f"there is no joint '{unable}'"
        existing = ", ".join(able) or "none"
        raise CallError(f"{whose} with the command interface '{interface}'; there are {existing}")
    return asked


def _controllers(joints: Sequence[str], interface: str, rate_hz: int) -> Mapping[str, Any]:
    """Return the parameters of a controller that forwards commands to joints."""
    return {
        "controller_manager": {
            "ros__parameters": {"update_rate": rate_hz, CONTROLLER: {"type": FORWARD}}
        },
        CONTROLLER: {"ros__parameters": {"joints": list(joints), "interface_name": interface}},
    }
