"""Write the arm's meshes and urdf/arm_parts.xacro anew, from the shapes in arm_meshes/.

Needs trimesh and manifold3d: `pip install '.[test]'` brings both.
"""

import argparse
import logging
import sys
from pathlib import Path

from arm_meshes.part_files import write_macros, write_mesh
from arm_meshes.parts import all_parts

logger = logging.getLogger(__name__)

PACKAGE = Path(__file__).resolve().parent.parent


def main(argv: list[str] | None = None) -> int:
    """Write the files and say how large each mesh is."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument(
        "--output", type=Path, default=PACKAGE, help="folder that gets meshes/ and urdf/"
    )
    output: Path = parser.parse_args(argv).output
    meshes, urdf = output / "meshes", output / "urdf"
    for folder in (meshes, urdf):
        folder.mkdir(parents=True, exist_ok=True)
    parts = all_parts()
    for part in parts:
        for piece in part.pieces:
            path = write_mesh(piece, meshes)
            logger.info("%s: %.1f kB", path.name, path.stat().st_size / 1000)
    write_macros(parts, urdf / "arm_parts.xacro", PACKAGE.name, "Every part has 0.1 kg")
    return 0


if __name__ == "__main__":
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    sys.exit(main())
