"""servo_node: from a command to motion, beside a position controller's, and the rate of commands.

The myCobot runs at 100 Hz with a position controller, which a client commands directly and by jogs
of servo_node in turns. Then a jog goes on while the rate of its commands is counted in simulated
time, without plans beside it and with a client that keeps move_group busy.

    python benchmarks/jog.py
"""

import argparse
import contextlib
import tempfile
from collections.abc import Iterator
from pathlib import Path

import harness
import numpy as np
from planning_beside_control import CONTROLLERS, MODEL, PLANNER

CLIENT = Path(__file__).with_name("jog_client.py")
SERVO = """\
moveit_servo:
  move_group_name: arm
  command_out_type: std_msgs/Float64MultiArray
  command_out_topic: /position_controller/commands
"""
POSITION_CONTROLLER = """
position_controller:
  ros__parameters:
    joints:
      - ${prefix}link1_to_${prefix}link2
      - ${prefix}link2_to_${prefix}link3
      - ${prefix}link3_to_${prefix}link4
      - ${prefix}link4_to_${prefix}link5
      - ${prefix}link5_to_${prefix}link6
      - ${prefix}link6_to_${prefix}${flange_link}
"""
PERIOD_MS = 10.0


@contextlib.contextmanager
def robot() -> Iterator[None]:
    """Run the robot with a position controller, move_group and servo_node."""
    kind = "      type: position_controllers/JointGroupPositionController\n"
    text = CONTROLLERS.read_text().replace(
        "    arm_controller:\n", f"    position_controller:\n{kind}\n    arm_controller:\n", 1
    )
    with harness.fresh_domain(), tempfile.TemporaryDirectory() as folder:
        file, servo = Path(folder) / "controllers.yaml", Path(folder) / "servo.yaml"
        file.write_text(text + POSITION_CONTROLLER)
        servo.write_text(SERVO)
        suite = harness.Suite(
            *("arm_gazebo", "sim.launch.py", f"model:={MODEL}", f"controllers:={file}"),
            *("spawn:=joint_state_broadcaster,position_controller", "planning:=true"),
            *("servo:=true", f"servo_config:={servo}"),
            f"moveit_config:={CONTROLLERS.parent}",
        )
        try:
            suite.wait_until_ready()
            yield
        finally:
            suite.stop()


def answered(*words: str) -> dict:
    """Return what a client found."""
    client = harness.Client(*words, script=CLIENT)
    client.answer()
    answer = client.answer()
    client.stop()
    return answer


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--count", type=int, default=40, help="commands of each kind")
    parser.add_argument("--seconds", type=float, default=8.0, help="of each rate")
    options = parser.parse_args()
    with robot():
        latencies = answered("latency", str(options.count))
        alone = answered("rate", str(options.seconds))["rate"]
        planner = harness.Client(str(options.seconds + 5.0), script=PLANNER)
        planner.answer()
        beside = answered("rate", str(options.seconds))["rate"]
        plans = planner.answer()["answers"]
        planner.stop()
    rows = []
    medians = {}
    for name, key in (("position controller", "direct_s"), ("jog", "jog_s")):
        p50, p99 = harness.percentiles(np.array(latencies[key]) * 1e3, 50, 99)
        medians[key] = p50
        target = f"{medians['direct_s'] + PERIOD_MS:.1f} ms" if key == "jog_s" else ""
        measured = f"{p50:.1f} / {p99:.1f} ms (n={options.count})"
        rows.append(harness.Row(f"{name}: command to motion p50 / p99", measured, target))
    rows.append(harness.Row("jog: commands over those wanted", f"{100 * alone:.1f} %", "99 %"))
    rows.append(
        harness.Row(f"the same beside {plans} plans", f"{100 * beside:.1f} %", "99 %"),
    )
    harness.print_table("Jog at 100 Hz", rows)


if __name__ == "__main__":
    main()
