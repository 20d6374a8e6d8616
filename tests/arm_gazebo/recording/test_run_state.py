import numpy as np
import pytest

from arm_gazebo.recording.run_state import StateRow, chained_hashes, state_names

WELDED = """<mujoco><worldbody><body name="box"><freejoint name="free"/>
<geom type="box" size="0.1 0.1 0.1" mass="1"/></body></worldbody>
<equality><weld body1="box"/></equality></mujoco>"""


@pytest.fixture
def run(recorded, parts, tmp_path):
    world = tmp_path / "welded.xml"
    world.write_text(WELDED)
    return recorded(parts.pendulum(), world=world)


def test_a_row_holds_the_numbers_that_it_names(run):
    simulation = run.simulation
    simulation.data.qpos[:] += 0.3
    simulation.data.qvel[:] += 0.7
    run.run(3)
    row = StateRow(simulation, [run.manager])
    names = state_names(simulation.model, [run.manager])
    values = np.frombuffer(row.copy(simulation.time_s))
    assert len(names) == len(values) == row.width
    state = dict(zip(names, values.tolist(), strict=True))
    joint = simulation.model.joint("j")
    assert state["time"] == simulation.data.time
    assert state["position of joint j"] == simulation.data.qpos[joint.qposadr[0]] != 0.0
    assert state["velocity of joint j"] == simulation.data.qvel[joint.dofadr[0]] != 0.0
    position = run.manager.resources.state_names.index("j/position")
    assert (
        state["state j/position of /controller_manager"] == (run.manager.resources.states[position])
    )


def test_flags_of_mujoco_are_numbers_of_the_present_state(run):
    simulation = run.simulation
    row = StateRow(simulation, [run.manager])
    flag = state_names(simulation.model, [run.manager]).index("active equality 0")
    assert np.frombuffer(row.copy(0.0))[flag] == 1.0
    simulation.data.eq_active[0] = False
    assert np.frombuffer(row.copy(0.0))[flag] == 0.0


def test_each_of_several_controls_has_its_name(recorded, parts, several_controls):
    run = recorded(parts.pendulum(), world=several_controls)
    data = run.simulation.data
    names = state_names(run.simulation.model, [run.manager])
    row = StateRow(run.simulation, [run.manager])
    assert len(names) == row.width
    data.ctrl[:] = range(1, 9)
    state = dict(zip(names, np.frombuffer(row.copy(0.0)).tolist(), strict=True))
    assert state["control of drive p, number 2 of 2"] == 2.0
    assert state["control of drive o, number 3 of 3"] == 5.0
    assert state["control of drive j"] == 8.0


def test_a_copy_stays_as_it_is(run):
    row = StateRow(run.simulation, [run.manager])
    before = row.copy(run.simulation.time_s)
    kept = bytes(bytearray(before))
    run.run(5)
    assert before == kept != row.copy(run.simulation.time_s)


def test_each_hash_depends_on_all_states_so_far():
    hashes = list(chained_hashes(0, [b"a", b"b", b"b"]))
    assert len({*hashes, 0}) == 4
    assert list(chained_hashes(hashes[0], [b"b", b"b"])) == hashes[1:]
    assert list(chained_hashes(0, [b"x", b"b", b"b"]))[2] != hashes[2]
