"""The myCobot 280 with its adaptive gripper: names without prefix, and positions in rad."""

JOINTS = (
    "link1_to_link2",
    "link2_to_link3",
    "link3_to_link4",
    "link4_to_link5",
    "link5_to_link6",
    "link6_to_link6_flange",
)
"""The joints of the arm."""
HOME = (0.0,) * len(JOINTS)


def prefixed_joints(prefix: str) -> list[str]:
    """Return the arm's joints, with the prefix before the names of both links of each joint."""
    return [prefix + name.replace("_to_", f"_to_{prefix}") for name in JOINTS]


HAND = "gripper_base"
"""The link that carries the fingers: x sideways, y forward, z up."""
GRASP_CENTRE = (0.0, 0.069, -0.01)
"""The centre between the pads, 30 mm apart, in the frame of the hand (m)."""
WIDE_OPEN, OPEN, CLOSED = 0.15, 0.0, -0.7
"""Positions of the gripper: 43 mm, 39 mm and 6 mm between the pads."""
