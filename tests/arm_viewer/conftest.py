"""A planar arm of two links with its groups, for the tests of plans on the page."""

import pytest
from robots import joint, link, robot

from arm_description.urdf.parser import parse_urdf
from arm_planning.robot.build import planning_model
from arm_planning.robot.srdf import parse_srdf

URDF = robot(
    link("base"),
    link("upper"),
    link("hand"),
    joint("shoulder", "base", "upper"),
    joint("elbow", "upper", "hand", xyz="1 0 0"),
    joint("wrist", "hand", "finger", kind="fixed", xyz="1 0 0", limits=None),
    link("finger"),
)
SRDF = """<robot name='r'>
  <group name='fingers'><link name='finger'/></group>
  <group name='arm'><chain base_link='base' tip_link='finger'/></group>
  <group_state name='up' group='arm'><joint name='shoulder' value='-1.5'/></group_state>
</robot>"""


@pytest.fixture(scope="session")
def model():
    """Return the planning model of the arm; it lies along x at 0."""
    described = parse_urdf(URDF)
    return planning_model(described, parse_srdf(SRDF, described), warn=lambda _: None)
