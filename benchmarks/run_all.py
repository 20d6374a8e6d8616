"""Runs every benchmark of the suite and writes RESULTS.md, with the machine named.

    python benchmarks/run_all.py

Takes half an hour; run it on a machine that does nothing else, with the suite installed
(not editable: compiled modules are part of the start-up time).
"""

import datetime
import subprocess
import sys
from pathlib import Path

import harness

FOLDER = Path(__file__).parent
SCRIPTS = (
    "start_up.py",
    "command_line.py",
    "control_loop.py",
    "many_arms.py",
    "trajectory_control.py",
    "busy_process.py",
    "as_fast_as_possible.py",
    "lock_step.py",
    "camera_rate.py",
    "load_time.py",
    "world_changes.py",
    "snapshots.py",
    "physics_speed.py",
    "library.py",
    "gym_speed.py",
    "workarounds.py",
    "bag_recording.py",
    "recording_jumps.py",
    "run_recording.py",
    "repeatability.py",
    "soak.py",
    "sweep.py",
    "inverse_kinematics.py",
    "planning.py",
    "planning_quality.py",
    "move_group.py",
    "planning_beside_control.py",
    "seeing.py",
    "jog.py",
    "real_arm.py",
    "fuzzing.py",
    "page.py",
)


def main() -> None:
    """Write the table of all scripts."""
    parts = [
        "# Benchmark results\n",
        f"{datetime.date.today()}, {harness.machine()}.\n",
        "Targets stand beside the figures. Absolute times depend on the machine and on what else "
        "runs on it; each script says how it measures.\n",
    ]
    for script in SCRIPTS:
        print(f"{script} ...", flush=True)
        done = subprocess.run(
            [sys.executable, str(FOLDER / script)],
            stdout=subprocess.PIPE,
            text=True,
            check=True,
        )
        parts.append(done.stdout.strip() + "\n")
        (FOLDER / "RESULTS.md").write_text("\n".join(parts))


if __name__ == "__main__":
    main()
