"""A simulation goes back to a saved state, or to its start, and repeats from there to the bit."""

import numpy as np
import pytest
from robots import CAN, control, pendulum, sensor

from arm_control.controllers.goals import GoalOutcome
from arm_control.errors import StateError
from arm_gazebo.errors import RequestError
from arm_sim import CallError, JointTrajectory, Simulation

FOLLOWER = "joint_trajectory_controller"
NOISE = """<always_on>1</always_on><imu><linear_acceleration><x><noise type='gaussian'>
<mean>0</mean><stddev>0.1</stddev></noise></x></linear_acceleration></imu>"""
NOISY = pendulum(
    sensor("bob", "imu", "imu", NOISE),
    control(
        "<joint name='hinge'><command_interface name='position'/>"
        "<state_interface name='position'/></joint>",
        "<sensor name='imu'><state_interface name='linear_acceleration.x'/></sensor>",
    ),
    name="noisy",
)


def follower() -> Simulation:
    return Simulation("arm", arguments={"camera": "none"}, spawn=[FOLLOWER])


def course(sim: Simulation, ticks: int = 60) -> list[list[float]]:
    """Return the joints' positions and velocities in the next control periods."""
    states = []
    for _ in range(ticks):
        sim.step()
        states.append([*sim.joints.position, *sim.joints.velocity, *sim.joints.effort])
    return states


def test_a_restored_simulation_goes_on_to_the_bit_with_its_goal():
    with follower() as sim:
        goal = sim[FOLLOWER].follow(JointTrajectory([0.5], [[0.3, 0.4, -0.2, 0.1]]))
        sim.run(0.2)
        here = sim.save()
        first = course(sim)
        assert goal.result.outcome is GoalOutcome.SUCCEEDED
        sim.restore(here)
        assert sim.time_s == here.time_s
        assert not goal.done
        assert course(sim) == first
        assert goal.result.outcome is GoalOutcome.SUCCEEDED


def test_things_come_and_go_with_the_state(sim):
    before = sim.save()
    sim.spawn(CAN, pose=(0.6, 0.2, 0.3))
    sim.run(0.1)
    falling = sim.save()
    height_m = sim.pose("can")[2, 3]
    first = course(sim)
    sim.restore(before)
    assert "can" not in sim.entities
    sim.restore(falling)
    assert sim.pose("can")[2, 3] == height_m
    assert course(sim) == first


def test_a_reset_simulation_repeats_its_first_run_to_the_bit(sim):
    def run() -> list[list[float]]:
        sim["position_controller"].command([1.0, 0.5, 0.1, 0.5])
        return course(sim)

    first = run()
    sim.spawn(CAN)
    sim.reset()
    assert sim.time_s == 0.0
    assert "can" not in sim.entities
    assert run() == first


def test_a_reset_with_a_seed_is_a_new_simulation_with_this_seed(tmp_path):
    file = tmp_path / "noisy.urdf"
    file.write_text(NOISY)

    def readings(sim: Simulation) -> list[float]:
        values = []
        for _ in range(20):
            values.append(sim.states["imu/linear_acceleration.x"])
            sim.step()
        return values

    with Simulation(file, seed=3) as sim, Simulation(file, seed=4) as other:
        third, fourth = readings(sim), readings(other)
        assert third != fourth
        sim.reset(seed=4)
        assert readings(sim) == fourth
        sim.reset(seed=3)
        assert readings(sim) == third


def test_a_snapshot_belongs_to_its_simulation(sim):
    with follower() as other, pytest.raises(CallError, match="saved by another simulation"):
        sim.restore(other.save())


def test_a_recorded_run_keeps_its_seed(sim, tmp_path):
    with sim.record(tmp_path / "arm.run"), pytest.raises(CallError, match="keeps its seed"):
        sim.reset(seed=1)


def test_what_cannot_be_saved_is_named(sim):
    sim["position_controller"].core.secret = lambda: None
    with pytest.raises(StateError, match="'position_controller' cannot be saved: its attribute"):
        sim.save()


def test_a_thousand_restores_end_where_one_does(sim):
    sim["position_controller"].command([0.5, 0.5, 0.1, 0.5])
    sim.run(0.1)
    here = sim.save()
    first = course(sim, 3)
    for _ in range(1000):
        sim.restore(here)
        sim.step()
    sim.restore(here)
    assert np.array_equal(course(sim, 3), first)


def test_a_file_brings_another_simulation_to_the_state(tmp_path):
    file = tmp_path / "here.snapshot"
    with follower() as sim:
        sim[FOLLOWER].follow(JointTrajectory([0.5], [[0.3, 0.4, -0.2, 0.1]]))
        sim.spawn(CAN, pose=(0.6, 0.2, 0.3))
        sim.run(0.2)
        sim.save(file)
        first = course(sim)
    with follower() as other:
        other.restore(file)
        assert other.time_s == pytest.approx(0.2)
        assert "can" in other.entities
        assert course(other) == first


def test_a_file_of_another_robot_is_refused(sim, tmp_path):
    sim.save(tmp_path / "arm.snapshot")
    with (
        Simulation("mycobot") as other,
        pytest.raises(RequestError, match="is not that of this simulation"),
    ):
        other.restore(tmp_path / "arm.snapshot")
    with pytest.raises(RequestError, match="cannot read"):
        sim.restore(tmp_path / "nowhere")


def test_things_that_sleep_on_one_another_are_restored_while_others_are_awake():
    with Simulation("arm", arguments={"camera": "none"}) as sim:
        for height, name in enumerate(("lower", "upper", "lonely")):
            sim.spawn(CAN, name=name, pose=(0.6, 0.0 if height < 2 else 0.5, 0.06 + 0.11 * height))
        sim.run_until(lambda: sim.parts.physics.data.ntree_awake == 1, 10.0)
        assert {contact.other for contact in sim.contacts("upper")} == {"lower::can::body"}
        saved = sim.save()
        for place, name in enumerate(("lower", "upper", "lonely")):
            sim.place(name, (1.0, 0.5 * place, 1.0))
        sim.step()
        assert sim.parts.physics.data.ntree_awake > 1
        sim.restore(saved)
        assert sim.parts.physics.data.ntree_awake == 1
        sim.run(0.5)
        assert sim.pose("upper")[2, 3] == pytest.approx(0.15, abs=0.01)
