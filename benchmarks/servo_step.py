"""How the servos answer a step of all joints: this project's arm, or any URDF.

    python benchmarks/servo_step.py [ROBOT.urdf ...] [--step 0.3] [--payload 0.2]

Simulation time only: the figures do not depend on the machine.
"""

import argparse
import itertools
import os
import sys
from pathlib import Path

import harness
import numpy as np

from arm_control.hardware.info import HardwareInfo, InterfaceInfo, JointInfo
from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.robot import Robot
from arm_description.xacro.expansion import expand_xacro
from arm_gazebo.drives.driven_joint import DriveMode
from arm_gazebo.model.builder import build_model
from arm_gazebo.physics.physics import Physics
from arm_gazebo.physics_timing import physics_timing
from arm_gazebo.robot.part import BuildOptions

OWN_ARM = Path(__file__).parents[1] / "arm_description" / "urdf" / "arm.urdf.xacro"
SETTLE_S, WATCH_S = 2.0, 3.0


def hardware(robot: Robot) -> HardwareInfo:
    """Return hardware that commands every joint that can be commanded."""
    position = (InterfaceInfo("position"),)
    names = [j.name for j in robot.joints if j.type.is_scalar and j.mimic is None]
    return HardwareInfo(
        "all", "system", "none", tuple(JointInfo(n, position, position) for n in names)
    )


class Step:
    """One simulation in which all joints step at once."""

    def __init__(self, robot: Robot, rate_hz: float, payload_kg: float) -> None:
        timing = physics_timing(rate_hz)
        built = build_model(robot, [hardware(robot)], options=BuildOptions(step_s=timing.step_s))
        self.warnings = built.report.warnings
        self.simulation = Physics(built, timing)
        self.rate_hz = rate_hz
        self.joints = self.simulation.servo.joints
        self._addresses = [joint.qpos_address for joint in self.joints]
        for index in range(len(self.joints)):
            self.simulation.servo.set_mode(index, DriveMode.POSITION)
        moving = [body for body in built.bodies.values() if built.model.body_weldid[body] > 0]
        self.simulation.data.xfrc_applied[moving[-1], 2] = -9.81 * payload_kg
        self.run(SETTLE_S)
        self.start = self.positions()

    def positions(self) -> np.ndarray:
        """Return the positions of the driven joints."""
        return self.simulation.data.qpos[self._addresses]

    def run(self, seconds: float) -> np.ndarray:
        """Run; return positions after every control period, shape (ticks, joints)."""
        rows = []
        for _ in range(round(seconds * self.rate_hz)):
            self.simulation.advance()
            rows.append(self.positions())
        return np.array(rows)

    def figures(self, way: float) -> tuple[float, float, float]:
        """Step all joints; return overshoot in %, sag in mrad and the slowest rise in s."""
        middle = [(max(j.lower, -9.0) + min(j.upper, 9.0)) / 2 for j in self.joints]
        ways = np.where(self.start < middle, way, -way)
        for index, target in enumerate(self.start + ways):
            self.simulation.servo.command(index, float(target))
        done = (self.run(WATCH_S) - self.start) / ways
        rises = (done > 0.9).argmax(axis=0) + 1
        return (
            100 * max(0.0, float(done.max()) - 1),
            1000 * float(np.abs((done[-1] - 1) * ways).max()),
            float(rises.max()) / self.rate_hz,
        )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("robots", nargs="*", type=Path, default=[OWN_ARM])
    parser.add_argument("--step", type=float, default=0.3, help="rad or m")
    parser.add_argument("--payload", type=float, default=0.2, help="kg the drives do not know of")
    arguments = parser.parse_args()
    os.environ.setdefault("AMENT_PREFIX_PATH", sys.prefix)
    rows = []
    for path in arguments.robots:
        robot = parse_urdf(expand_xacro(path, {}), str(path))
        for rate_hz, payload_kg in itertools.product((30, 100, 500), (0.0, arguments.payload)):
            step = Step(robot, rate_hz, payload_kg)
            overshoot, sag, rise = step.figures(arguments.step)
            rows.append(
                harness.Row(
                    f"{robot.name}, {len(step.joints)} joints, {rate_hz} Hz, "
                    f"{payload_kg:g} kg at the last link",
                    f"{overshoot:.2f} %, {sag:.2f} mrad, {rise:.2f} s",
                    "" if payload_kg else "3 %, 3 mrad",
                )
            )
    harness.print_table(f"Step of {arguments.step:g} on all joints: overshoot, sag, rise", rows)


if __name__ == "__main__":
    main()
