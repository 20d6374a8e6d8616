"""A planar arm with a gripper finger, for tests of planning."""

from arm_description import Robot, parse_urdf
from arm_planning.robot.model import JointGroup, PlanningLimits, PlanningModel

PLANAR = """
<robot name="planar">
  <link name="base"/>
  <link name="upper"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.02 0.02"/>
    </geometry></collision></link>
  <link name="fore"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.02 0.02"/>
    </geometry></collision></link>
  <link name="tip"/>
  <link name="finger"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="2"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/>
    <origin xyz="0.5 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-2.5" upper="2.5" effort="1" velocity="2"/></joint>
  <joint name="flange" type="fixed"><parent link="fore"/><child link="tip"/>
    <origin xyz="0.5 0 0"/></joint>
  <joint name="grip" type="prismatic"><parent link="tip"/><child link="finger"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="0.02" effort="1" velocity="0.1"/>
    <mimic joint="elbow" multiplier="0.01"/></joint>
</robot>
"""


def planar_robot() -> Robot:
    """Return the arm: two links of 0.5 m in the xy plane."""
    return parse_urdf(PLANAR)


def planar_model() -> PlanningModel:
    """Return the arm with one group, `arm`, and one named state, `folded`."""
    robot = planar_robot()
    limits = (PlanningLimits(-3.0, 3.0, 2.0, 4.0), PlanningLimits(-2.5, 2.5, 2.0, 4.0))
    group = JointGroup(
        "arm",
        ("shoulder", "elbow"),
        (False, False),
        limits,
        ("upper", "fore", "tip"),
        base="base",
        tip="tip",
    )
    states = {("arm", "folded"): {"shoulder": 0.0, "elbow": 2.0}}
    return PlanningModel(robot, "base", ("shoulder", "elbow"), {"arm": group}, states)
