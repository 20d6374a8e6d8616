"""Write the meshes of a robot and the xacro macros of its parts, from the shapes in meshes/.

python tools/make_meshes.py arm

It needs trimesh and manifold3d: `pip install '.[test]'` installs both.
"""

import argparse
import logging
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from meshes.arm.bracket import bracket
from meshes.arm.foot import foot
from meshes.arm.gripper import finger, gripper_plate
from meshes.arm.servo import horn, servo
from meshes.arm.turntable import disc, plate
from meshes.arm.wrist import wrist
from meshes.mycobot import arm as mycobot
from meshes.mycobot import gripper as mycobot_gripper
from meshes.mycobot.base import base_plate, pedestal
from meshes.part import Part
from meshes.part_files import write_macros, write_mesh
from meshes.rosmaster import camera, chassis, imu, lidar, wheel
from meshes.whole_parts import read_colours, write_collision_mesh, write_coloured_mesh

REPOSITORY = Path(__file__).resolve().parents[1]

logger = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class Robot:
    """The files to write for one robot.

    Attributes:
        package: folder of the package for the files.
        macros: path in the package of the file with a xacro macro for each part.
        parts: returns every part once; links that look the same share one.
        masses: start of the sentence about the masses in the file of macros.
        visual: path in the package of the folder for the meshes that are seen.
        collision: path of the folder for a mesh of each part's collision shapes; "" for none.
        materials: path of the xacro file with the colours of a .dae of each part beside its
            meshes; "" for none.
    """

    package: str
    macros: str
    parts: Callable[[], tuple[Part, ...]]
    masses: str
    visual: str = "meshes"
    collision: str = ""
    materials: str = ""


def arm_parts() -> tuple[Part, ...]:
    """Return the parts of the arm, from the floor to the fingertips."""
    arm = (foot(), plate(), disc(), servo(), horn(), bracket(), wrist())
    return (*arm, gripper_plate(), finger())


def mycobot_parts() -> tuple[Part, ...]:
    """Return the parts of the myCobot, each named after its link."""
    links = (mycobot.shoulder(), mycobot.upper_arm(), mycobot.forearm(), mycobot.forearm_elbow())
    gripper = [
        make(side)
        for side in ("left", "right")
        for make in (mycobot_gripper.finger, mycobot_gripper.bars, mycobot_gripper.geared_lever)
    ]
    hand = (mycobot.wrist(), mycobot.flange(), mycobot_gripper.gripper_body())
    return (base_plate(), pedestal(), *links, *hand, *gripper)


def rosmaster_parts() -> tuple[Part, ...]:
    """Return the parts of the ROSMASTER X3, each named after its link."""
    wheels = [wheel(end, side) for end in ("front", "back") for side in ("left", "right")]
    return (chassis(), *wheels, camera(), lidar(), imu())


ROBOTS = {
    "arm": Robot("arm_description", "urdf/arm_parts.xacro", arm_parts, "Every part has 0.1 kg"),
    "mycobot": Robot(
        "robots/mycobot_description",
        "urdf/mech/mycobot_280_parts.xacro",
        mycobot_parts,
        "Every part has its known mass",
        visual="meshes/mycobot_280/visual",
        collision="meshes/mycobot_280/collision",
        materials="urdf/mech/mycobot_280_materials.xacro",
    ),
    "rosmaster": Robot(
        "robots/yahboom_rosmaster_description",
        "urdf/mech/rosmaster_x3_parts.xacro",
        rosmaster_parts,
        "Every part has its known mass",
    ),
}


def write_files(robot: Robot, folder: Path) -> None:
    """Write the meshes and the macros of a robot to a folder; log the size of each mesh."""
    visual, macros = folder / robot.visual, folder / robot.macros
    for needed in (visual, macros.parent):
        needed.mkdir(parents=True, exist_ok=True)
    parts = robot.parts()
    written = [write_mesh(piece, visual) for part in parts for piece in part.pieces]
    if robot.materials:
        colours = read_colours(REPOSITORY / robot.package / robot.materials)
        written += [write_coloured_mesh(part, colours, visual) for part in parts]
    if robot.collision:
        (folder / robot.collision).mkdir(parents=True, exist_ok=True)
        written += [write_collision_mesh(part, folder / robot.collision) for part in parts]
    for path in written:
        logger.info("%s: %.1f kB", path.name, path.stat().st_size / 1000)
    write_macros(parts, macros, f"{Path(robot.package).name}/{robot.visual}", robot.masses)


def main(argv: list[str] | None = None) -> int:
    """Write the files of the robot that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("robot", choices=ROBOTS)
    parser.add_argument(
        "--output", type=Path, help="folder for the files (default: the robot's package)"
    )
    arguments = parser.parse_args(argv)
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    robot = ROBOTS[arguments.robot]
    write_files(robot, arguments.output or REPOSITORY / robot.package)
    return 0


if __name__ == "__main__":
    sys.exit(main())
