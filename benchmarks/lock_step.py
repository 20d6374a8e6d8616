"""How many control periods a second a simulation makes in lock-step with a controller over ROS."""

import argparse
import contextlib
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import harness
import psutil
import yaml

from arm_description.resources import resolve_uri
from arm_description.xacro.expansion import expand_xacro

CLIENT = Path(__file__).with_name("lock_step_client.py")


@contextlib.contextmanager
def simulation(lockstep: str) -> Iterator[psutil.Process]:
    """Run the arm without its camera, as fast as possible, in a domain of its own."""
    arm = str(resolve_uri("package://arm_description/urdf/arm.urdf.xacro"))
    settings = {
        "robot_description": expand_xacro(arm, {"camera": "none"}),
        "spawn": "joint_state_broadcaster,position_controller",
        "real_time_factor": 0,
        "lockstep": lockstep,
        "lockstep_timeout": 60,
    }
    parameters = yaml.safe_load(harness.CONTROLLERS.format(rate_hz=100))
    parameters["arm_gazebo"] = {"ros__parameters": settings}
    with harness.fresh_domain(), tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "parameters.yaml"
        path.write_text(yaml.safe_dump(parameters))
        process = subprocess.Popen(
            [
                *(sys.executable, "-m", "arm_gazebo.arm_gazebo_node", "--ros-args"),
                *("--params-file", str(path)),
            ],
            stderr=subprocess.DEVNULL,
        )
        try:
            yield psutil.Process(process.pid)
        finally:
            process.send_signal(signal.SIGINT)
            process.wait(30.0)


def measured(ticks: int) -> dict[str, float]:
    """Return the rate, and where the time of a control period goes, in microseconds."""
    with simulation("/partner") as process:
        client = harness.Client(str(ticks), script=CLIENT)
        client.answer()  # It is warm.
        before = process.cpu_times()
        answer = client.answer()
        after = process.cpu_times()
        client.process.wait(30.0)
    used_s = after.user + after.system - before.user - before.system
    return {
        "rate": ticks / answer["seconds"],
        "callback_us": 1e6 * answer["callback_s"] / ticks,
        "partner_us": 1e6 * answer["cpu_s"] / ticks,
        "simulation_us": 1e6 * used_s / ticks,
    }


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ticks", type=int, default=5000)
    parser.add_argument("--runs", type=int, default=3)
    arguments = parser.parse_args()
    runs = [measured(arguments.ticks) for _ in range(arguments.runs)]
    each = {name: sorted(run[name] for run in runs) for name in runs[0]}
    middle = {name: values[len(values) // 2] for name, values in each.items()}
    harness.print_table(
        "Lock-step",
        [
            harness.Row(
                "control periods a second with one partner in Python: median, worst",
                f"{middle['rate']:.0f}, {each['rate'][0]:.0f} (n={arguments.runs})",
                "1000",
            ),
            harness.Row(
                "processor time of a period: simulation; partner, of that its own callback",
                f"{middle['simulation_us']:.0f} us; {middle['partner_us']:.0f} us, "
                f"{middle['callback_us']:.0f} us",
            ),
        ],
    )


if __name__ == "__main__":
    main()
