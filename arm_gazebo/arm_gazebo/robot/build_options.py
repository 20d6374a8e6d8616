"""What the user chooses about the model of a robot."""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from arm_description.robot import Pose
from arm_gazebo.physics_timing import LARGEST_STEP_S

Base = Literal["fixed", "free"]


@dataclass(frozen=True, slots=True)
class BuildOptions:
    """Choices for `build_model`.

    Attributes:
        step_s: physics step; see `physics_timing`.
        base: whether a root link that hangs on no `world` link is bolted down or stands free.
        spawn: pose of the robot's root in the world. By default the world's origin for a fixed
            base, and for a free one the height at which it stands on the floor.
        self_collide: whether links of the robot touch each other, as in Gazebo off by default.
        strict: a mesh that is missing or unreadable is an error, not a box and a warning.
        package_path: folders searched for package:// and model:// after the installed packages.
        mesh_cache: folder where meshes that were read are kept for the next time; None for none.
    """

    step_s: float = LARGEST_STEP_S
    base: Base = "fixed"
    spawn: Pose | None = None
    self_collide: bool = False
    strict: bool = False
    package_path: tuple[Path, ...] = ()
    mesh_cache: Path | None = None
