"""What one control period costs without ROS: physics, servos, hardware; best of many."""

import argparse
import math
import os
import sys
import timeit
from collections.abc import Callable
from pathlib import Path

import harness
import mujoco
import numpy as np

from arm_control.hardware.info import parse_hardware_info
from arm_description.urdf.parser import parse_urdf
from arm_description.xacro.expansion import expand_xacro
from arm_gazebo.hardware.simulated_hardware import SimulatedHardware
from arm_gazebo.model.builder import build_model
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics_timing import physics_timing
from arm_gazebo.robot.part import BuildOptions

ARM = Path(__file__).parents[1] / "arm_description" / "urdf" / "arm.urdf.xacro"
REPEATS, CALLS = 100, 50


def best_us(function: Callable[[], object]) -> float:
    """Return the least mean time of a call: what else runs on the machine only adds to it."""
    return min(timeit.repeat(function, number=CALLS, repeat=REPEATS)) / CALLS * 1e6


class Bench:
    """The arm with its hardware, every joint claimed by position."""

    def __init__(self, rate_hz: float, world: str) -> None:
        text = expand_xacro(ARM, {"camera": "none"})
        info = parse_hardware_info(text)
        timing = physics_timing(rate_hz)
        options = BuildOptions(step_s=timing.step_s)
        self.simulation = Physics(build_model(parse_urdf(text), info, (), world, options), timing)
        self.hardware = SimulatedHardware(self.simulation, info[0])
        self.states = np.zeros(len(self.hardware.state_interfaces))
        self.commands = np.zeros(len(self.hardware.command_interfaces))
        self.hardware.bind(self.states, self.commands)
        names = [n for n in self.hardware.command_interfaces if n.endswith("/position")]
        self.hardware.perform_command_mode_switch(names, [])
        self._claimed = [self.hardware.command_interfaces.index(name) for name in names]
        self._phase = 0.0
        for _ in range(int(2 * rate_hz)):
            self.tick()

    def tick(self) -> None:
        """Advance by one control period, as a controller manager does."""
        self.hardware.write(0.0, 0.0)
        self.simulation.advance()
        self.hardware.read(0.0, 0.0)

    def moving_tick(self) -> None:
        """Advance by one control period with new commands for every joint."""
        self.stream()
        self.tick()

    def stream(self) -> None:
        """Write the next sample of a smooth motion."""
        self._phase += 0.01
        for index in self._claimed:
            self.commands[index] = 0.3 * math.sin(self._phase)

    def bare_steps(self) -> None:
        """Do the physics steps of one control period and nothing else, contacts included."""
        model = self.simulation.model
        model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        mujoco.mj_step(model, self.simulation.data, self.simulation.timing.steps)


def rows(rate_hz: float, world: str) -> list[harness.Row]:
    """Return the figures of one control rate in one world."""
    bench = Bench(rate_hz, world)
    rest = best_us(bench.tick)
    hands = best_us(lambda: (bench.hardware.write(0.0, 0.0), bench.hardware.read(0.0, 0.0)))
    bare = best_us(bench.bare_steps)
    moving = best_us(bench.moving_tick) - best_us(bench.stream)
    where = f"{world}, {rate_hz:g} Hz"
    return [
        harness.Row(
            f"{where}: bare mj_step, {bench.simulation.timing.steps} steps", f"{bare:.1f} us", ""
        ),
        harness.Row(f"{where}: write, advance, read, arm at rest", f"{rest:.1f} us", ""),
        harness.Row(f"{where}: of it write and read", f"{hands:.1f} us", "8 us"),
        harness.Row(f"{where}: write, advance, read, all joints moving", f"{moving:.1f} us", ""),
        harness.Row(
            f"{where}: real-time factor at rest, moving",
            f"{1e6 / rate_hz / rest:.0f} x, {1e6 / rate_hz / moving:.0f} x",
            "",
        ),
    ]


def main() -> None:
    """Print the table."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    os.environ.setdefault("AMENT_PREFIX_PATH", sys.prefix)
    harness.print_table(
        "One control period without ROS",
        [row for world in ("empty", "objects") for rate in (100, 500) for row in rows(rate, world)],
    )


if __name__ == "__main__":
    main()
