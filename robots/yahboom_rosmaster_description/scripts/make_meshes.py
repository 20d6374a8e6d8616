"""Write the ROSMASTER X3's meshes and urdf/mech/rosmaster_x3_parts.xacro anew.

Needs trimesh and manifold3d: `pip install '.[test]'` brings both.
"""

import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]
DRAWING = PACKAGE.parents[1] / "arm_description" / "scripts"
"""Where outlines, solids and the writing of files come from."""

if __name__ == "__main__":
    sys.path.append(str(DRAWING))
    from arm_meshes.command_line import run
    from rosmaster_meshes.parts import all_parts

    run(
        "Write the ROSMASTER X3's meshes and macros anew.",
        PACKAGE,
        all_parts(),
        "urdf/mech/rosmaster_x3_parts.xacro",
        "Every part has its known mass",
    )
