"""What broken files and requests cost: ten thousand of each, in processes that may die of them."""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import harness

FUZZ = Path(__file__).parents[1] / "tests" / "fuzz" / "fuzz.py"
TARGETS = (
    *("urdf", "xacro", "srdf", "sdf", "mjcf", "meshes", "yaml", "mcap", "arguments"),
    *("planning", "requests"),
)


def row(target: str, inputs: int) -> harness.Row:
    """Return the figures of one reader."""
    command = [sys.executable, str(FUZZ), target, "--inputs", str(inputs)]
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True)
    result = json.loads(done.stdout)
    return harness.Row(
        f"{target}: inputs, refused; slowest, most memory",
        f"{result['inputs']}, {result['refused']}; {result['slowest_s'] * 1e3:.0f} ms, "
        f"{result['most_mb']:.0f} MB",
        f"no other end: {len(result['failures'])} failures",
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--inputs", type=int, default=10_000)
    options = parser.parse_args()
    rows = [row(target, options.inputs) for target in TARGETS]
    harness.print_table("Broken files: a result or a sentence", rows)


if __name__ == "__main__":
    main()
