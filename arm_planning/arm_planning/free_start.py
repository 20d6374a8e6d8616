"""Prints where the joints of a robot start so that it touches nothing, as JSON.

    python -m arm_planning.free_start PACKAGE_PATH < ROBOT.urdf

A process of its own, because the launcher, which asks, would keep MuJoCo in its memory. What is
wrong with a robot is left to those that use it.
"""

import json
import sys
from pathlib import Path

from arm_description.errors import DescriptionError
from arm_description.resources import ResourceFinder
from arm_description.urdf.parser import ignore_remark, parse_urdf
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.errors import PlanningError
from arm_planning.srdf_maker import free_start


def main() -> None:
    """Print the positions of the joints that do not start at zero."""
    paths = [Path(part) for part in sys.argv[1].split(":") if part]
    urdf = sys.stdin.buffer.read().decode()
    positions: dict[str, float] = {}
    try:
        robot = parse_urdf(urdf, remark=ignore_remark)
        positions = free_start(robot, MeshPieces(ResourceFinder.of_description(urdf, paths)))
    except (DescriptionError, PlanningError):
        pass
    json.dump({joint: value for joint, value in positions.items() if value}, sys.stdout)


if __name__ == "__main__":
    main()
