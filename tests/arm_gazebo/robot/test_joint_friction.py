"""Dry friction of a joint: stiff only where the joint's drive cannot overcome it."""

import mujoco
import pytest

from arm_description.urdf.parser import parse_urdf
from arm_gazebo.model.builder import build_model

URDF = """
<robot name="r"><link name="base"/><link name="arm"/>
<joint name="j" type="revolute"><parent link="base"/><child link="arm"/>
  <dynamics friction="1.0"/><limit lower="-1" upper="1" effort="{effort}" velocity="1"/></joint>
</robot>
"""


@pytest.mark.parametrize(
    ("effort", "stiff"),
    [(2.0, False), (0.5, True), (0.0, False)],
    ids=["weaker than the drive", "stronger than the drive", "no limit of effort"],
)
def test_friction_is_stiff_if_the_drive_cannot_overcome_it(effort, stiff):
    model = build_model(parse_urdf(URDF.format(effort=effort)), []).model
    assert model.dof_frictionloss.tolist() == [1.0]
    default = mujoco.MjSpec().default.joint.solimp_friction[0]
    assert (model.dof_solimp[0, 0] != pytest.approx(default)) == stiff
