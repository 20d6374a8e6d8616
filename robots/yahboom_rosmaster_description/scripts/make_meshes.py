"""Write the ROSMASTER X3's meshes and urdf/mech/rosmaster_x3_parts.xacro anew.

Needs trimesh and manifold3d: `pip install '.[test]'` brings both.
"""

import argparse
import logging
import sys
from pathlib import Path

logger = logging.getLogger(__name__)

PACKAGE = Path(__file__).resolve().parents[1]
DRAWING = PACKAGE.parents[1] / "arm_description" / "scripts"
"""Where outlines, solids and the writing of files come from."""


def main(argv: list[str] | None = None) -> int:
    """Write the files and say how large each mesh is."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument(
        "--output", type=Path, default=PACKAGE, help="folder that gets meshes/ and urdf/mech/"
    )
    output: Path = parser.parse_args(argv).output
    sys.path.append(str(DRAWING))
    from arm_meshes.part_files import write_macros, write_mesh
    from rosmaster_meshes.parts import all_parts

    meshes, urdf = output / "meshes", output / "urdf" / "mech"
    for folder in (meshes, urdf):
        folder.mkdir(parents=True, exist_ok=True)
    parts = all_parts()
    for part in parts:
        for piece in part.pieces:
            path = write_mesh(piece, meshes)
            logger.info("%s: %.1f kB", path.name, path.stat().st_size / 1000)
    write_macros(
        parts, urdf / "rosmaster_x3_parts.xacro", PACKAGE.name, "Every part has its known mass"
    )
    return 0


if __name__ == "__main__":
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    sys.exit(main())
