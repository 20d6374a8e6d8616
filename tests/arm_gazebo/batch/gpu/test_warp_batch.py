"""Copies by MuJoCo Warp: near those on the host, each for itself, with sentences for its limits."""

from collections.abc import Iterator

import mujoco
import numpy as np
import pytest

from arm_gazebo.batch.copies import CommandBounds
from arm_gazebo.batch.host_batches import PhysicsBatch
from arm_gazebo.errors import BatchError
from arm_sim import Simulation

wp = pytest.importorskip("warp", reason="the extra `gpu` is not installed")
pytest.importorskip("mujoco_warp", reason="the extra `gpu` is not installed")

from arm_gazebo.batch.gpu import warp_batch  # noqa: E402
from arm_gazebo.batch.gpu.warp_batch import (  # noqa: E402
    Room,
    WarpBatch,
    check_overflow,
    room_of,
)

COPIES = 3
ROUNDING = 1e-6
"""How far 32 bits may take a joint from the host within some periods, in rad."""


@pytest.fixture(params=["cpu", "cuda"])
def device(request) -> str:
    if request.param == "cuda" and not wp.get_cuda_device_count():
        pytest.skip("there is no GPU")
    return request.param


@pytest.fixture
def arm() -> Iterator[Simulation]:
    with Simulation("arm", arguments={"camera": "none"}) as simulation:
        yield simulation


def bounds_of(sim: Simulation) -> CommandBounds:
    return CommandBounds(sim.parts.physics, sim.parts.robot.hardware)


def on_device(sim: Simulation, device: str, copies: int = COPIES) -> WarpBatch:
    return WarpBatch(sim.parts.physics, bounds_of(sim), copies, device)


def goals(sim: Simulation, seed: int = 0, copies: int = COPIES) -> np.ndarray:
    shape = (copies, len(sim.parts.physics.servo.joints))
    return np.random.default_rng(seed).uniform(-0.5, 0.5, shape)


@pytest.mark.parametrize("robot", ["arm", "mycobot"])
def test_copies_stay_near_those_on_the_host(robot, device):
    with Simulation(robot, arguments={"camera": "none"} if robot == "arm" else {}) as sim:
        there = on_device(sim, device)
        here = PhysicsBatch(sim.parts.physics, bounds_of(sim), COPIES)
        addresses = [joint.qpos_address for joint in sim.parts.physics.servo.joints]
        for seed in range(3):
            # Commands after the recording of the graph must reach it, too.
            values = goals(sim, seed)
            for batch in (there, here):
                assert not batch.advance(values, periods=4).any()
            apart = np.abs(there.qpos - here.qpos)[:, addresses]
            assert apart.max() < ROUNDING
        assert np.ptp(there.qpos[:, addresses], axis=0).max() > 1e-3
        assert np.abs(there.qvel - here.qvel)[:, addresses[0]].max() < 1e-3


def test_actuators_with_several_controls_are_refused_in_a_sentence(several_controls, device):
    sentence = "MuJoCo Warp cannot simulate this model: .*mjTRN_SO3"
    with (
        Simulation("arm", world=several_controls, arguments={"camera": "none"}) as sim,
        pytest.raises(BatchError, match=sentence),
    ):
        on_device(sim, device)


def test_copies_restart_alone_and_repeat_their_run(arm, device):
    batch, untouched = on_device(arm, device), on_device(arm, device)
    values = goals(arm)
    start = batch.qpos.copy()
    once = []
    for _ in range(6):
        batch.advance(values)
        once.append(batch.qpos[[0, 2]].copy())
    untouched.advance(values, periods=6)
    assert np.array_equal(batch.qpos, untouched.qpos)
    batch.reset([0, 2])
    assert np.array_equal(batch.qpos[[0, 2]], start[[0, 2]])
    assert not batch.qvel[[0, 2]].any()
    for tick in range(6):
        batch.advance(values)
        untouched.advance(values)
        assert np.array_equal(batch.qpos[[0, 2]], once[tick])
        assert np.array_equal(batch.qpos[1], untouched.qpos[1])
        assert np.array_equal(batch.qvel[1], untouched.qvel[1])
    assert not np.array_equal(batch.qpos[0], untouched.qpos[0])
    batch.reset([])
    assert not np.array_equal(batch.qpos[1], start[1])
    with pytest.raises(IndexError):
        batch.reset([COPIES])
    batch.reset([-1])
    assert np.array_equal(batch.qpos[2], start[2])


@pytest.mark.parametrize("number", [np.nan, np.inf, 1e12])
def test_a_copy_that_becomes_unstable_restarts_alone(arm, device, number):
    batch, untouched = on_device(arm, device), on_device(arm, device)
    values = goals(arm)
    start = batch.qpos.copy()
    first = []
    for one in (batch, untouched):
        one.advance(values)
        first.append(one.qpos.copy())
    velocities = batch._data.qvel.numpy()
    velocities[1, 2] = number
    batch._data.qvel.assign(velocities)
    assert batch.advance(values, periods=3).tolist() == [False, True, False]
    untouched.advance(values, periods=3)
    assert np.array_equal(batch.qpos[1], start[1])
    assert not batch.qvel[1].any()
    for again in range(4):
        assert np.array_equal(batch.qpos[[0, 2]], untouched.qpos[[0, 2]])
        assert not batch.advance(values).any()
        untouched.advance(values)
        if again == 0:
            assert np.array_equal(batch.qpos[1], first[0][1])


def test_links_are_where_the_host_says_and_looking_changes_nothing(arm, device):
    batch, alone = on_device(arm, device), on_device(arm, device)
    model, bodies = arm.parts.physics.model, arm.parts.physics.built.bodies
    for _ in range(3):
        for one in (batch, alone):
            one.advance(goals(arm), periods=2)
        for name in ("dyn5", "crawer_base"):
            found = batch.link_positions(bodies[name])
            for copy in range(COPIES):
                data = mujoco.MjData(model)
                data.qpos[:] = batch.qpos[copy]
                mujoco.mj_kinematics(model, data)
                assert np.allclose(found[copy], data.xpos[bodies[name]], atol=1e-6)
            found[:] = 0.0
            assert batch.link_positions(bodies[name]).any()
    assert np.array_equal(batch.qpos, alone.qpos)
    before = batch.link_positions(bodies["dyn5"])
    batch.reset([1])
    after = batch.link_positions(bodies["dyn5"])
    assert np.array_equal(before[[0, 2]], after[[0, 2]])
    assert not np.array_equal(before[1], after[1])
    with pytest.raises(IndexError):
        batch.link_positions(model.nbody)


def test_too_many_contacts_are_a_sentence(device, monkeypatch):
    monkeypatch.setattr(warp_batch, "room_of", lambda model: Room(contacts=3, rows=70))
    with Simulation("mycobot") as sim:
        batch = on_device(sim, device)
        with pytest.raises(BatchError, match=r"\d copies have more contacts than there is room"):
            batch.advance(np.zeros((COPIES, 7)))


def test_the_things_of_the_mycobot_have_room():
    with Simulation("mycobot") as sim:
        physics = sim.parts.physics
        data = mujoco.MjData(physics.model)
        data.qpos[:] = physics.built.qpos
        model, room = physics.model, room_of(physics.model)
        model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
        model.opt.enableflags &= ~int(mujoco.mjtEnableBit.mjENBL_SLEEP)
        for _ in range(100):
            mujoco.mj_step(model, data)
        assert 0 < 4 * data.ncon < room.contacts
        assert data.nefc < 0.3 * room.rows


def test_a_solver_at_its_last_iteration_is_no_lack_of_room():
    kinds = warp_batch.mujoco_warp.OverflowType
    room = Room(contacts=5, rows=9)
    flags = np.array([0, int(kinds.ITERATIONS), int(kinds.LS_ITERATIONS)], dtype=np.int32)
    check_overflow(flags, room)
    flags[0] = int(kinds.NEFC)
    with pytest.raises(BatchError, match=r"1 copies have more contacts .*: 5 contacts and 9 rows"):
        check_overflow(flags, room)


def test_what_mujoco_warp_cannot_simulate_is_a_sentence(arm, device):
    arm.parts.physics.model.opt.solver = mujoco.mjtSolver.mjSOL_PGS
    with pytest.raises(BatchError, match=r"MuJoCo Warp cannot simulate this model: .*PGS"):
        on_device(arm, device)


@pytest.mark.parametrize(
    ("values", "problem"),
    [
        (np.zeros((1, 4)), r"need the shape \(3, 4\), not \(1, 4\)"),
        (np.full((3, 4), np.nan), "need finite values"),
    ],
)
def test_commands_that_are_none_are_refused(arm, device, values, problem):
    batch = on_device(arm, device)
    with pytest.raises(BatchError, match=problem):
        batch.advance(values)
