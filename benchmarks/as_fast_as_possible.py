"""How much faster than real time the suite runs, beside a bare `mj_step` loop on the same model."""

import argparse
import time

import harness
import mujoco

from arm_control.hardware.info import parse_hardware_info
from arm_description.urdf.parser import parse_urdf
from arm_description.xacro.expansion import expand_xacro
from arm_gazebo.model.builder import build_model


def clock_now(seconds: float = 0.05) -> tuple[float, float]:
    """Return one pair of wall time and simulation time, from /clock."""
    client = harness.Client("record", "--topic", "/clock", "--seconds", str(seconds))
    answer = client.answer()
    client.stop()
    return answer["arrivals_s"][-1], answer["stamps_s"][-1]


def suite_factor(seconds: float, *arguments: str) -> float:
    """Return simulated over wall time of the suite, watched at two moments only."""
    with harness.suite("camera:=none", "real_time_factor:=0", *arguments, rate_hz=100):
        wall0, simulated0 = clock_now()
        time.sleep(seconds)
        wall1, simulated1 = clock_now()
    return (simulated1 - simulated0) / (wall1 - wall0)


def bare_factor(seconds: float) -> float:
    """Return simulated over wall time of a loop that does nothing but `mj_step`."""
    from ament_index_python.packages import get_package_share_directory

    path = get_package_share_directory("arm_description") + "/urdf/arm.urdf.xacro"
    text = expand_xacro(path, {"camera": "none"})
    model = build_model(parse_urdf(text), parse_hardware_info(text)).model
    data = mujoco.MjData(model)
    step_s = model.opt.timestep
    steps = 0
    started = time.perf_counter()
    while time.perf_counter() - started < seconds:
        for _ in range(500):
            mujoco.mj_step(model, data)
        steps += 500
    return steps * step_s / (time.perf_counter() - started)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=8.0)
    parser.add_argument("--runs", type=int, default=3)
    arguments = parser.parse_args()
    runs = [
        (
            suite_factor(arguments.seconds),
            suite_factor(arguments.seconds, "use_robot_state_pub:=false"),
            bare_factor(arguments.seconds),
        )
        for _ in range(arguments.runs)
    ]
    whole, unheard, bare = (sorted(column)[len(column) // 2] for column in zip(*runs, strict=True))
    harness.print_table(
        "As fast as possible",
        [
            harness.Row(
                "100 Hz, all topics of the broadcaster and /clock, while the state publisher "
                "listens: real-time factor",
                f"{whole:.0f} x",
                "200 x",
            ),
            harness.Row("the same while nobody listens", f"{unheard:.0f} x", "200 x"),
            harness.Row(
                "bare `mj_step` loop in the same run; ratio to the first",
                f"{bare:.0f} x; {whole / bare:.2f}",
                "0.25",
            ),
        ],
    )


if __name__ == "__main__":
    main()
