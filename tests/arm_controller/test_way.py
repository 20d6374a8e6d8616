from arm_controller.way import WayPoint, reverse_way, way_to


def test_a_way_to_a_pose_ends_at_rest():
    assert way_to([1.0, 2.0], 3.0) == (WayPoint(3.0, (1.0, 2.0), (0.0, 0.0)),)


def test_back_is_the_same_way_from_its_end():
    way = (
        WayPoint(0.5, (1.0,), (3.0,)),
        WayPoint(2.0, (2.0,), (1.0,)),
        WayPoint(3.0, (4.0,), (0.0,)),
    )
    assert reverse_way(way, (0.0,)) == (
        WayPoint(1.0, (2.0,), (-1.0,)),
        WayPoint(2.5, (1.0,), (-3.0,)),
        WayPoint(3.0, (0.0,), (0.0,)),
    )
