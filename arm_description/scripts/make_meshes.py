"""Write the arm's meshes and urdf/arm_parts.xacro anew, from the shapes in arm_meshes/.

Needs trimesh and manifold3d: `pip install '.[test]'` brings both.
"""

from pathlib import Path

from arm_meshes.command_line import run
from arm_meshes.parts import all_parts

PACKAGE = Path(__file__).resolve().parents[1]

if __name__ == "__main__":
    run(
        "Write the arm's meshes and macros anew.",
        PACKAGE,
        all_parts(),
        "urdf/arm_parts.xacro",
        "Every part has 0.1 kg",
    )
