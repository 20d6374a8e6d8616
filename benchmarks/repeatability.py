"""Whether runs over ROS repeat to the last bit, whatever goes on beside them.

    python benchmarks/repeatability.py [--seconds 8]

Each condition is a launch of its own: commands from another process, spawned and deleted things, a
switch. It is recorded, and then replayed without ROS.
"""

import argparse
import itertools
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import harness
from harness import Row

from arm_gazebo.recording.replay import Replay
from arm_gazebo.recording.run_file import RecordedInput, RunFile

CRATE = """<robot name="crate"><link name="base"><inertial><mass value="1"/>
<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link></robot>"""
READY_S = 120.0
COMMANDER = """
import itertools, sys, time
import rclpy
from std_msgs.msg import Float64MultiArray
rclpy.init()
node = rclpy.create_node("commander")
publisher = node.create_publisher(Float64MultiArray, "/position_controller/commands", 10)
for i in itertools.count():
    values = [0.5 * ((i * k) % 7 - 3) / 3 for k in (1, 2, 3, 5)]
    publisher.publish(Float64MultiArray(data=values))
    time.sleep(0.013)
"""


@dataclass(frozen=True, slots=True)
class Condition:
    """What goes on beside a run.

    Attributes:
        name: for people.
        launch: arguments of the launch.
        beside: `arm` verbs that run all the time.
        verbs: `arm` verbs that are run one after the other, again and again.
        burners: processes that only use the processor.
    """

    name: str
    launch: Sequence[str] = ()
    beside: Sequence[Sequence[str]] = ()
    verbs: Sequence[Sequence[str]] = ()
    burners: int = 0


CONDITIONS = (
    Condition("real time"),
    Condition("as fast as possible", ["real_time_factor:=0"]),
    Condition("half of real time", ["real_time_factor:=0.5"]),
    Condition("three times real time", ["real_time_factor:=3"]),
    Condition("no camera", ["camera:=none"]),
    Condition("a subscriber of the camera", beside=[["topic", "hz", "/videocamera"]]),
    Condition("five subscribers of /joint_states", beside=[["topic", "hz", "/joint_states"]] * 5),
    Condition("the page", ["viewer:=true", "viewer_port:=0"]),
    Condition("pauses and steps", verbs=[["sim", "pause"], ["sim", "step", "7"], ["sim", "play"]]),
    Condition("other speeds", verbs=[["sim", "speed", "2"], ["sim", "speed", "0.5"]]),
    Condition("both cores busy", burners=4),
)


def arm(*words: str, **options: object) -> "subprocess.Popen[str]":
    """Start a verb of `arm`."""
    return subprocess.Popen(
        [sys.executable, "-m", "arm_cli", *words],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        text=True,
        **options,  # pyright: ignore[reportArgumentType]
    )


def wait_until_ready(log: Path, launched: "subprocess.Popen[str]") -> None:
    """Block until the launch says that it is ready."""
    deadline_s = time.monotonic() + READY_S
    while not any(line.startswith("ready ") for line in log.read_text().splitlines()):
        if time.monotonic() > deadline_s or launched.poll() is not None:
            sys.exit(f"the launch is not ready:\n{log.read_text()}")
        time.sleep(0.1)


def record(condition: Condition, path: Path, seconds: float) -> None:
    """Run a launch under a condition, recorded to a file."""
    log, crate = path.with_suffix(".log"), path.with_suffix(".urdf")
    crate.write_text(CRATE)
    with log.open("w") as stream:
        launched = subprocess.Popen(
            [sys.executable, "-m", "arm_cli", "launch", f"record_run:={path}", *condition.launch],
            stdin=subprocess.DEVNULL,
            stdout=stream,
            stderr=subprocess.STDOUT,
            text=True,
        )
    wait_until_ready(log, launched)
    beside = [arm(*words) for words in condition.beside]
    beside += [
        subprocess.Popen([sys.executable, "-c", "while True: pass"])
        for _ in range(condition.burners)
    ]
    beside.append(subprocess.Popen([sys.executable, "-c", COMMANDER], stderr=subprocess.DEVNULL))
    verbs = [
        *condition.verbs,
        ["sim", "spawn", str(crate), "--pose", "1", "0", "0.5", "0", "0", "0"],
        ["control", "switch_controllers", "--deactivate", "position_controller"],
        ["control", "switch_controllers", "--activate", "position_controller"],
    ]
    end_s = time.monotonic() + seconds
    for words in itertools.cycle(verbs):
        arm(*words).wait()
        if time.monotonic() > end_s:
            break
    for process in beside:
        process.terminate()
        process.wait()
    launched.send_signal(signal.SIGINT)
    launched.wait()


def result(condition: Condition, path: Path) -> Row:
    """Replay a recording."""
    inputs = 0

    def count(_item: RecordedInput) -> None:
        nonlocal inputs
        inputs += 1

    found = Replay(RunFile(path)).run(before_input=count)
    equal = "equal" if found.difference is None else f"differs: {found.difference.lines[0]}"
    what = f"{found.periods} control periods, {inputs} inputs: {equal}"
    return Row(condition.name, what, "equal")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=8.0)
    options = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for number, condition in enumerate(CONDITIONS):
            path = Path(folder, f"{number}.run")
            record(condition, path, options.seconds)
            rows.append(result(condition, path))
            print(rows[-1], file=sys.stderr, flush=True)
    harness.print_table("Runs over ROS, recorded and replayed", rows)


if __name__ == "__main__":
    main()
