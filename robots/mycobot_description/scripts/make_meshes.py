"""Write the myCobot's meshes and urdf/mech/mycobot_280_parts.xacro anew, from mycobot_meshes/.

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
    from mycobot_meshes.parts import all_parts

    run(
        "Write the myCobot's meshes and macros anew.",
        PACKAGE,
        all_parts(),
        "urdf/mech/mycobot_280_parts.xacro",
        "Every part has its known mass",
    )
