from arm_planning.ros.servo import unknown_names


def test_moveit_servos_names_are_known_and_others_are_not():
    known = {"publish_period", "scale.linear", "use_smoothing", "pose_tracking.linear_tolerance"}
    assert list(unknown_names(known)) == []
    (near,) = unknown_names({"publish_perod"})
    assert near.endswith("publish_perod; did you mean 'publish_period'?")
    (far,) = unknown_names({"xyzzy"})
    assert far.startswith("there is no parameter moveit_servo.xyzzy; none of the ")
