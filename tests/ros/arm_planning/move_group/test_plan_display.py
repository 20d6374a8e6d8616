"""The topic display_planned_path: RViz sees each plan, whoever asked for it."""

import pytest
from moveit_msgs.msg import DisplayTrajectory, MotionSequenceItem, MotionSequenceRequest
from moveit_msgs.srv import GetMotionSequence


@pytest.fixture
def shown(planning):
    """Return the collector of what is displayed; move_group knows its subscription."""
    collector = planning.client.subscribe(DisplayTrajectory, "/display_planned_path")
    planning.client.be_known_to_server("/plan_kinematic_path")
    return collector


@pytest.mark.parametrize("asks", ["service", "action"])
def test_a_plan_is_displayed_from_its_start(planning, shown, request_of, joint_goal, joints, asks):
    request = request_of(joint_goal(joints(0.4)), start=joints(0.8))
    if asks == "service":
        planned = planning.plan(request).trajectory
    else:
        planned = planning.move(request, plan_only=True).result.planned_trajectory
    (message,) = shown.wait_for(1)
    assert message.model_id == "mycobot_280"
    assert message.trajectory == [planned]
    start = message.trajectory_start.joint_state
    at = start.position[start.name.index("link1_to_link2")]
    assert at == pytest.approx(0.8)


def test_a_sequence_is_displayed_as_one_plan(planning, shown, request_of, joint_goal, joints):
    ptp = {"max_velocity_scaling_factor": 0.5, "max_acceleration_scaling_factor": 0.5}
    arm = request_of(joint_goal(joints(0.4)), **ptp)
    gripper = request_of(joint_goal({"gripper_controller": -0.2}), group_name="gripper", **ptp)
    items = [MotionSequenceItem(req=each) for each in (arm, gripper)]
    asked = GetMotionSequence.Request(request=MotionSequenceRequest(items=items))
    response = planning.call("/plan_sequence_path", asked).response
    (message,) = shown.wait_for(1)
    assert message.trajectory == response.planned_trajectories
