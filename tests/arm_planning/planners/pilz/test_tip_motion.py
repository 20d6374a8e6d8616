import numpy as np
import pytest

from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import MoveItErrorCode, PlanningError
from arm_planning.planners.pilz.cartesian_limits import CartesianLimits
from arm_planning.planners.pilz.tip_motion import tip_motion
from arm_planning.planners.pose_line import PoseLine
from arm_planning.robot.model import JointGroup, PlanningLimits


class TwoBranches:
    """A sliding joint whose solution changes to another branch at 0.05 m."""

    group = JointGroup("g", ("slide",), (False,), (PlanningLimits(-9.0, 9.0, 1.0, 1.0),), ("tip",))

    def follow(self, pose, seed):
        x = pose.position[0]
        return np.array([x if x < 0.05 else x + 1.0])

    def tip_pose(self, q):
        x = float(q[0])
        return RigidTransform((x if x < 0.05 else max(x - 1.0, 0.05), 0.0, 0.0))


def test_a_jump_to_another_branch_is_refused_where_it_is():
    line = PoseLine(RigidTransform(), RigidTransform((0.1, 0.0, 0.0)))
    with pytest.raises(PlanningError) as error:
        tip_motion("LIN", line, TwoBranches(), np.zeros(1), CartesianLimits(), 1.0, 1.0)
    assert error.value.code is MoveItErrorCode.PLANNING_FAILED
    assert "joint 'slide' would have to jump by 1 " in str(error.value)
    assert "0.050 of 0.100 m along its path" in str(error.value)
