"""CI's lock file holds what the pinned wheels bring with them."""

import re
from importlib.metadata import PackageNotFoundError, requires
from pathlib import Path

from declared_dependencies import DEPENDENCIES

ROOT = Path(__file__).parents[2]
NAME = re.compile(r"[\w.-]+")


def name_of(requirement: str) -> str:
    match = NAME.match(requirement)
    assert match, requirement
    return re.sub(r"[-_.]+", "-", match[0]).lower()


def brought_by(name: str, found: set[str]) -> set[str]:
    """Add a ROS wheel that is installed, and those that it needs."""
    if name.startswith("ros-") and name not in found:
        try:
            needed = requires(name) or []
        except PackageNotFoundError:
            # Of an extra that nobody asked for.
            return found
        found.add(name)
        for requirement in needed:
            brought_by(name_of(requirement), found)
    return found


def test_every_ros_wheel_is_locked():
    wheels: set[str] = set()
    for requirement in DEPENDENCIES:
        brought_by(name_of(requirement), wheels)
    lines = (ROOT / ".ci/constraints.txt").read_text().splitlines()
    locked = {name_of(line) for line in lines if line and not line.startswith("#")}
    assert len(wheels) > len(DEPENDENCIES)
    assert wheels - locked == set()
