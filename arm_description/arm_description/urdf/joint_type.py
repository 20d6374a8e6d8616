"""The joint types and their properties.

A new type starts here; all code that depends on the type uses these properties.
"""

from enum import StrEnum


class JointType(StrEnum):
    """A joint's type; each member equals its name in a URDF."""

    FIXED = "fixed"
    REVOLUTE = "revolute"
    CONTINUOUS = "continuous"
    PRISMATIC = "prismatic"
    FLOATING = "floating"
    PLANAR = "planar"

    @property
    def turns(self) -> bool:
        """Whether the position is an angle about the axis."""
        return self in (JointType.REVOLUTE, JointType.CONTINUOUS)

    @property
    def slides(self) -> bool:
        """Whether the position is a length along the axis."""
        return self is JointType.PRISMATIC

    @property
    def is_scalar(self) -> bool:
        """Whether the position is one number: such a joint has a state and takes commands."""
        return self.turns or self.slides

    @property
    def is_static(self) -> bool:
        """Whether the child link stays at the joint's origin; planar ones do, as in ROS 2."""
        return self in (JointType.FIXED, JointType.PLANAR)

    @property
    def has_axis(self) -> bool:
        """Whether the type uses a URDF's <axis>."""
        return self.is_scalar or self is JointType.PLANAR

    @property
    def wraps(self) -> bool:
        """Whether the position is unlimited: a full turn leads to the same pose."""
        return self is JointType.CONTINUOUS

    @property
    def needs_limit(self) -> bool:
        """Whether a URDF must have a <limit> with lower and upper."""
        return self.is_scalar and not self.wraps

    @property
    def unit(self) -> str:
        """Unit of the position."""
        return "m" if self.slides else "rad"

    @property
    def default_speed(self) -> float:
        """Default maximum speed towards a position, in `unit`/s, if the URDF has none."""
        return 0.5 if self.slides else 3.0
