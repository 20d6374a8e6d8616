"""Links on which gravity does not act: the drives need not hold them up."""

import numpy as np
import pytest

from arm_gazebo.batch.copies import CommandBounds
from arm_gazebo.batch.host_batches import PhysicsBatch, SerialBatch
from arm_gazebo.drives.servo_tuning import weak_drives
from arm_gazebo.robot.gazebo_tags import parse_gazebo_tags

GOAL = (0.4, 0.6, 0.5, -0.8)


def weightless(urdf: str, *links: str, tag: str = "<gravity>0</gravity>") -> str:
    each = "".join(f'<gazebo reference="{link}">{tag}</gazebo>' for link in links)
    return urdf.replace("</robot>", f"{each}</robot>")


@pytest.mark.parametrize(
    ("tag", "held"),
    [
        ("<gravity>false</gravity>", True),
        ("<gravity>0</gravity>", True),
        ("<turnGravityOff>true</turnGravityOff>", True),
        ("<gravity>1</gravity>", False),
        ("<turnGravityOff>false</turnGravityOff>", False),
    ],
)
def test_a_free_pendulum_swings_only_if_gravity_acts(bench, parts, tag, held):
    urdf = weightless(parts.pendulum(), "bob", tag=tag)
    arm = bench(urdf, hold_joints=False)
    [angle] = arm.run(0.2)[-1]
    assert (abs(angle) < 1e-9) == held
    assert parse_gazebo_tags(urdf).findings == ()


@pytest.mark.parametrize("links", [("l0", "l1", "l2", "l3"), ("l2", "l3"), ()])
def test_drives_bear_the_other_links_only_and_reach_their_goal(bench, parts, links):
    arm = bench(weightless(parts.serial_arm(4, 10.0, 0.8), *links))
    arm.claim()
    arm.command(*GOAL)
    positions = arm.run(4.0)
    assert positions[-1] == pytest.approx(GOAL, abs=1e-4)
    assert (positions.max(axis=0) <= np.maximum(GOAL, 0.0) + 1e-3).all()
    efforts = np.abs(arm.state("effort"))
    # The last link is the wrist's whole load.
    assert (efforts[3] < 1e-3) == bool(links)
    assert (efforts.max() < 1e-3) == (len(links) == 4)


def test_a_drive_that_holds_a_weightless_link_is_strong_enough(bench, parts):
    weak = parts.pendulum(limit='lower="-3" upper="3" effort="1" velocity="3"')
    found = {}
    for urdf in (weak, weightless(weak, "bob")):
        physics = bench(urdf).simulation
        found[urdf] = [
            name
            for name, _ in weak_drives(physics.model, physics.servo.joints, physics.servo.tuning)
        ]
    assert list(found.values()) == [["j"], []]


@pytest.mark.parametrize("make", [PhysicsBatch, SerialBatch])
def test_copies_go_through_the_same_states(bench, parts, make):
    arm = bench(weightless(parts.serial_arm(4, 10.0, 0.8), "l1", "l3"))
    arm.claim()
    # The drives of copies are in the modes of the simulation's.
    bounds = CommandBounds(arm.simulation, [arm.hardware])
    batch = make(arm.simulation, bounds, 2)
    arm.command(*GOAL)
    for tick in range(100):
        arm.tick()
        assert not batch.advance(np.array([GOAL, GOAL])).any()
        assert np.array_equal(batch.qpos[1], arm.simulation.data.qpos), f"tick {tick}"
    assert np.ptp(batch.qpos) > 0.3


def test_copies_on_a_device_stay_near_those_on_the_host(bench, parts):
    pytest.importorskip("warp", reason="the extra `gpu` is not installed")
    pytest.importorskip("mujoco_warp", reason="the extra `gpu` is not installed")
    from arm_gazebo.batch.gpu.warp_batch import WarpBatch

    arm = bench(weightless(parts.serial_arm(4, 10.0, 0.8), "l1", "l3"))
    arm.claim()
    bounds = CommandBounds(arm.simulation, [arm.hardware])
    there = WarpBatch(arm.simulation, bounds, 2, "cpu")
    here = PhysicsBatch(arm.simulation, bounds, 2)
    goals = np.array([GOAL, GOAL])
    there.reset([0])
    for batch in (there, here):
        assert not batch.advance(goals, periods=6).any()
    assert np.abs(there.qpos - here.qpos).max() < 1e-6
    assert np.ptp(here.qpos) > 1e-3
