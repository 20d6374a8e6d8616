"""The dependencies of the suite, which its build chooses by the ROS 2 distribution."""

import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]
HOOK = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["metadata"]["hooks"]
WHEELS: dict[str, list[str]] = HOOK["custom"]["ros"]
"""The ROS wheels by the distribution that ROS_DISTRO names."""
DEPENDENCIES = [*WHEELS["jazzy"], *HOOK["custom"]["dependencies"]]
"""What pip gets where the variable is not set."""
