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

HAND = "gripper_base"
"""The link that carries the fingers: x across, y ahead, z up."""
GRASP_CENTRE = (0.0, 0.069, -0.01)
"""Middle between the pads, closed on 30 mm, in the hand's frame (m)."""
WIDE_OPEN, OPEN, CLOSED = 0.15, 0.0, -0.7
"""Positions of the gripper: 43 mm, 39 mm and 6 mm between the pads."""
