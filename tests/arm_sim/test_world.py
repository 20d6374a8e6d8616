"""Things in the world: spawned, moved, seen, touched and deleted."""

import numpy as np
import pytest
from robots import CAN

from arm_gazebo.errors import RequestError
from arm_sim import CallError


def test_a_spawned_thing_falls_and_rests_on_the_floor(sim):
    assert sim.spawn(CAN, pose=(0.6, 0.2, 0.2)) == "can"
    assert "can" in sim.entities
    assert sim.pose("can")[:3, 3] == pytest.approx([0.6, 0.2, 0.2])
    assert sim.contacts("can") == ()
    sim.run(1.0)
    assert sim.pose("can")[2, 3] == pytest.approx(0.05, abs=1e-3)
    contacts = sim.contacts("can")
    assert {contact.other for contact in contacts} == {"world"}
    assert sum(contact.force for contact in contacts) == pytest.approx([0, 0, 0.981], abs=0.02)
    assert all(contact.normal == pytest.approx([0, 0, 1], abs=1e-3) for contact in contacts)


def test_the_floor_feels_the_opposite_force(sim):
    sim.spawn(CAN, pose=(0.6, 0.2, 0.05))
    sim.run(0.5)
    contacts = [contact for contact in sim.contacts("world") if "can" in contact.other]
    assert sum(contact.force for contact in contacts) == pytest.approx([0, 0, -0.981], abs=0.02)


def test_a_file_is_spawned_by_its_path(sim, tmp_path):
    file = tmp_path / "can.sdf"
    file.write_text(CAN)
    assert sim.spawn(file, name="tin", pose=(0.6, 0, 0.05)) == "tin"
    assert sim.spawn(str(file)) == "can"
    assert sim.spawn(file, pose=(0.9, 0, 0.05)) == "can_2"


def test_joints_are_the_same_after_the_world_has_changed(sim):
    sim["position_controller"].command([1.0, 0.5, 0.1, 0.5])
    sim.run(2.0)
    before = sim.joints.position
    sim.spawn(CAN, pose=(0.6, 0.2, 0.05))
    assert sim.joints.position.tolist() == before.tolist()
    sim["position_controller"].command([0.5, 0.5, 0.1, 0.5])
    sim.run(2.0)
    assert sim.joints.position == pytest.approx([0.5, 0.5, 0.1, 0.5], abs=1e-3)


@pytest.mark.parametrize(
    "pose",
    [
        (0.7, 0.1, 0.3, 0.0, 0.0, np.pi / 2),
        (0.7, 0.1, 0.3, 0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)),
        [[0, -1, 0, 0.7], [1, 0, 0, 0.1], [0, 0, 1, 0.3], [0, 0, 0, 1]],
    ],
)
def test_a_pose_may_be_written_in_several_ways(sim, pose):
    sim.spawn(CAN)
    sim.place("can", pose)
    expected = [[0, -1, 0, 0.7], [1, 0, 0, 0.1], [0, 0, 1, 0.3], [0, 0, 0, 1]]
    assert sim.pose("can") == pytest.approx(np.array(expected), abs=1e-9)


@pytest.mark.parametrize(
    "pose", ["here", (1, 2), (0, 0, np.nan), np.zeros((4, 4)), np.diag([1, 1, -1, 1]), (0,) * 7]
)
def test_a_bad_pose_gets_a_sentence(sim, pose):
    with pytest.raises(CallError, match="a pose is x y z, x y z roll pitch yaw"):
        sim.spawn(CAN, pose=pose)


def test_poses_are_seen_from_frames(sim):
    sim.spawn(CAN, pose=(0.0, 0.0, 0.5), frame="dyn3")
    sim.place("can", (0.1, 0.0, 0.0), frame="dyn3")
    assert sim.pose("can", frame="dyn3")[:3, 3] == pytest.approx([0.1, 0, 0], abs=1e-9)


def test_a_deleted_thing_is_gone(sim):
    sim.spawn(CAN, pose=(0.6, 0.2, 0.2))
    sim.delete("can")
    assert "can" not in sim.entities
    with pytest.raises(RequestError, match="no entity 'can'; there are arm"):
        sim.delete("can")


def test_what_does_not_exist_gets_the_sentence_of_the_node(sim):
    with pytest.raises(RequestError, match="no frame 'moon'"):
        sim.pose("moon")
    with pytest.raises(RequestError, match="no entity or link 'moon'; there are arm"):
        sim.contacts("moon")
    with pytest.raises(RequestError, match=r"nowhere\.sdf"):
        sim.spawn("nowhere.sdf")
    with pytest.raises(RequestError, match="'arm' is a robot of the launch"):
        sim.delete("arm")
