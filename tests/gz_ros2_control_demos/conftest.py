"""A demo's robot in the simulation with its controllers, as the launch files set it up; no ROS."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

from arm_control import ControllerContext, ControllerManager, SwitchRequest
from arm_control.controller import Controller
from arm_control.controller_switch import Strictness
from arm_control.hardware_info import parse_hardware_info
from arm_control.registry import controller_class
from arm_description.urdf import parse_urdf
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.launching.robot_setup import set_up_robot
from arm_gazebo.model.builder import build_model
from arm_gazebo.physics.simulation import Simulation
from arm_gazebo.physics.tick import SimulationTick
from arm_gazebo.physics_timing import physics_timing
from arm_gazebo.robot.build_options import BuildOptions
from arm_gazebo.robot.gazebo_tags import parse_gazebo_tags

RATE_HZ = 100
PACKAGE = "package://gz_ros2_control_demos"


class NoClock:
    def publish(self, time_s: float) -> None:
        """Nobody listens."""


class Demo:
    """One robot, its controllers active, as fast as possible."""

    def __init__(self, model: str, model_args: str, controllers_file: str, base: str) -> None:
        from arm_description.resources import resolve_uri

        file = resolve_uri(f"{PACKAGE}/config/{controllers_file}")
        setup = set_up_robot(f"{PACKAGE}/urdf/{model}", model_args, str(file))
        timing = physics_timing(RATE_HZ)
        hardware = parse_hardware_info(setup.description)
        self.built = build_model(
            parse_urdf(setup.description),
            hardware,
            options=BuildOptions(step_s=timing.step_s, base=base),
            tags=parse_gazebo_tags(setup.description),
        )
        self.simulation = Simulation(self.built, timing, True)
        parts = [SimulatedHardware(self.simulation, info) for info in hardware]
        self.manager = ControllerManager(parts, RATE_HZ)
        self.manager.bring_up()
        self.controllers: dict[str, Controller[Any]] = {}
        for name in setup.spawn:
            self._start(name, setup.controllers)
        self.tick = SimulationTick([self.manager], self.simulation, NoClock(), [], timing.period_s)

    def _start(self, name: str, content: Mapping[str, Any]) -> None:
        type_name = content["controller_manager"]["ros__parameters"][name]["type"]
        controller = controller_class(type_name)(ControllerContext(name, RATE_HZ))
        given = content.get(name, {"ros__parameters": {}})["ros__parameters"]
        self.manager.load_controller(controller, type_name)
        self.manager.configure_controller(name, controller.build_parameters(given))
        result = self.manager.switch_controller(SwitchRequest((name,), (), Strictness.STRICT))
        assert result.ok, result.message
        self.controllers[name] = controller

    def run(self, seconds: float, before_each: Callable[[], object] = lambda: None) -> None:
        """Let time pass; `before_each` is called before each cycle."""
        for _ in range(round(seconds * RATE_HZ)):
            before_each()
            self.tick()

    def position(self, joint: str) -> float:
        """Return where a joint is."""
        return float(self.simulation.data.qpos[self.built.joints[joint].qpos_address])

    def body(self, link: str) -> tuple[np.ndarray, np.ndarray]:
        """Return a link's place in the world, and its rotation matrix."""
        data, number = self.simulation.data, self.built.bodies[link]
        return data.xpos[number].copy(), data.xmat[number].reshape(3, 3).copy()


@pytest.fixture
def demo() -> type[Demo]:
    return Demo
