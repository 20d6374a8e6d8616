"""What the page makes of groups, named poses and goals."""

from arm_viewer.planning import GoalState, default_group, filled, named_poses


def test_the_first_chain_is_offered_first(model):
    assert default_group(model) == "arm"


def test_named_poses_are_those_of_the_group(model):
    assert named_poses(model, "arm") == {"up": {"shoulder": -1.5}}
    assert named_poses(model, "fingers") == {}


def test_joints_that_a_pose_does_not_name_stay_where_they_are(model):
    group = model.groups["arm"]
    present = {"shoulder": 0.3, "elbow": 0.4, "wheel": 9.0}
    assert filled(group, {"shoulder": -1.5}, present) == {"shoulder": -1.5, "elbow": 0.4}
    assert filled(group) == {"shoulder": 0.0, "elbow": 0.0}


def test_a_goal_says_all_that_is_wrong_with_it():
    assert GoalState("arm", {}).sentence == ""
    goal = GoalState("arm", {}, contacts=("a with b, touching",), problem="It is out of reach.")
    assert goal.sentence == "It is out of reach.\nThe goal is in collision: a with b, touching"
