"""The command line of every robot's make_meshes.py."""

import argparse
import logging
from pathlib import Path

from arm_meshes.part import Part
from arm_meshes.part_files import write_macros, write_mesh

logger = logging.getLogger(__name__)


def run(description: str, package: Path, parts: tuple[Part, ...], macros: str, masses: str) -> None:
    """Write a robot's meshes and macros, and say how large each mesh is.

    Args:
        description: of the script, for `--help`.
        package: the robot's package; the files go there unless the command line names a folder.
        parts: what the robot is made of.
        macros: path in the package of the file that gets a xacro macro for each part.
        masses: how that file's sentence on the masses begins.
    """
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument(
        "--output", type=Path, default=package, help=f"folder that gets meshes/ and {macros}"
    )
    output: Path = parser.parse_args().output
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    meshes, macros_file = output / "meshes", output / macros
    for folder in (meshes, macros_file.parent):
        folder.mkdir(parents=True, exist_ok=True)
    for part in parts:
        for piece in part.pieces:
            path = write_mesh(piece, meshes)
            logger.info("%s: %.1f kB", path.name, path.stat().st_size / 1000)
    write_macros(parts, macros_file, package.name, masses)
