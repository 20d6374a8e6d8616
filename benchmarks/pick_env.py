"""Steps of ArmPick a second of processor time, beside gymnasium-robotics' FetchPickAndPlace.

Both decide at 25 Hz and make 20 physics steps an action, with random actions. The peer gets an
environment of its own in a temporary folder, because it needs an older MuJoCo. One after the other,
so that what else runs on the machine slows both; the ratio is the median of the pairs. The peer is
installed from a package registry, so `run_all.py` leaves this script out.
"""

import argparse
import statistics
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

import harness

PEER = ("gymnasium-robotics==1.4.2", "mujoco==3.11.0")
CLIENT = Path(__file__).with_name("pick_env_client.py")


def peer_python(folder: Path) -> Path:
    """Install the peer into a new environment; return its Python."""
    venv.create(folder, with_pip=True)
    python = folder / "bin/python"
    subprocess.run([python, "-m", "pip", "install", "-q", *PEER], check=True)
    return python


def steps_per_s(python: Path, module: str, name: str, steps: int) -> float:
    """Return the steps of an environment a second of processor time."""
    command = [python, CLIENT, module, name, str(steps)]
    done = subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE)
    return float(done.stdout.split()[-1])


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pairs", type=int, default=5, help="pairs of measurements (5)")
    parser.add_argument("--steps", type=int, default=4000, help="steps of each (4000)")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        peer = peer_python(Path(folder))
        pairs = [
            (
                steps_per_s(
                    Path(sys.executable), "arm_sim.gym", "arm_sim/ArmPick-v0", options.steps
                ),
                steps_per_s(peer, "gymnasium_robotics", "FetchPickAndPlace-v4", options.steps),
            )
            for _ in range(options.pairs)
        ]
    ours, theirs = (statistics.median(one) for one in zip(*pairs, strict=True))
    ratio = statistics.median(one / other for one, other in pairs)
    row = harness.Row(
        "ArmPick; FetchPickAndPlace-v4, steps/s of processor time; ratio",
        f"{ours:,.0f}; {theirs:,.0f}; {ratio:.2f}",
        "ratio 2",
    )
    harness.print_table("Environments of a pick", [row])


if __name__ == "__main__":
    main()
