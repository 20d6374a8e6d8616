import mujoco
import numpy as np
import pytest

from arm_gazebo.drives.servo_tuning import (
    FULL_EFFORT_ERROR,
    GEAR_SHARE,
    TIME_CONSTANT_S,
    resistance,
    tune,
    weak_drives,
)

PERIOD_S = 0.01
ARMS = [(4, 1.3, 0.4), (6, 0.3, 0.28), (6, 18.0, 0.9), (7, 30.0, 1.2)]


def tuned(parts, urdf):
    built = parts.build(urdf)
    joints = [joint for joint in built.joints.values() if joint.actuator is not None]
    return built.model, joints, tune(built.model, joints, built.qpos, PERIOD_S)


def poses(model, tuning, count=100):
    """Yield inertia with rotors and gravity efforts of the driven joints in random poses."""
    data, full = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    random = np.random.default_rng(1)
    model.dof_armature[:] = tuning.coupling @ tuning.armature
    for _ in range(count):
        data.qpos[:] = random.uniform(-2.9, 2.9, model.nq)
        mujoco.mj_forward(model, data)
        mujoco.mj_fullM(model, data, full)
        yield full.copy(), data.qfrc_bias.copy()


@pytest.mark.parametrize(("dof", "mass_kg", "reach_m"), ARMS)
def test_no_saturated_drive_can_chatter_in_any_pose(parts, dof, mass_kg, reach_m):
    model, _, tuning = tuned(parts, parts.serial_arm(dof, mass_kg, reach_m))
    for inertia, _ in poses(model, tuning):
        surplus = 2 * inertia - model.opt.timestep * np.diag(tuning.damping)
        assert np.linalg.eigvalsh(surplus)[0] > -1e-9 * np.trace(inertia)


@pytest.mark.parametrize(("dof", "mass_kg", "reach_m"), ARMS)
def test_all_joints_can_brake_at_once_in_any_pose(parts, dof, mass_kg, reach_m):
    model, joints, tuning = tuned(parts, parts.serial_arm(dof, mass_kg, reach_m))
    efforts = np.array([joint.effort for joint in joints])
    random = np.random.default_rng(2)
    for inertia, gravity in poses(model, tuning):
        signs = random.choice([-1, 1], dof)
        assert (np.abs(inertia @ (signs * tuning.braking) + gravity) <= efforts * 1.05).all()


def test_every_drive_uses_its_whole_effort_at_an_error_of_20_mrad(parts):
    _, joints, tuning = tuned(parts, parts.serial_arm(6, 5.0, 0.6))
    for index, joint in enumerate(joints):
        assert tuning.bounds(index).slack <= 0.02 + 1e-12
        assert tuning.stiffness[index] * tuning.bounds(index).slack == pytest.approx(joint.effort)


def test_gravity_is_that_of_the_worst_pose(parts):
    _, _, tuning = tuned(parts, parts.pendulum())
    assert tuning.gravity == pytest.approx([0.5 * 9.81], rel=0.01)


def test_tuning_twice_changes_nothing(parts):
    model, joints, tuning = tuned(parts, parts.serial_arm(6, 5.0, 0.6))
    again = tune(model, joints, np.zeros(model.nq), PERIOD_S)
    assert again.damping == pytest.approx(tuning.damping)


def test_leader_feels_its_followers(parts):
    limit = 'lower="-1" upper="1" effort="5" velocity="1"'
    urdf = parts.robot(
        parts.link("base"),
        parts.link("left", 1.0),
        parts.link("right", 1.0),
        parts.joint("a", "base", "left", "prismatic", "0 0 1", limit=limit),
        parts.joint(
            "b",
            "base",
            "right",
            "prismatic",
            "0 0 1",
            limit=limit,
            more='<mimic joint="a" multiplier="3"/>',
        ),
        parts.ros2_control(["a"]),
    )
    model, _, tuning = tuned(parts, urdf)
    gear_kg = GEAR_SHARE * 5.0 / FULL_EFFORT_ERROR * TIME_CONSTANT_S * model.opt.timestep / 2
    [[(follower, armature)]] = tuning.gears
    assert follower == model.joint("b").dofadr
    assert armature == pytest.approx(gear_kg / 3**2)
    assert model.dof_armature == pytest.approx(0.0)
    assert tuning.followers == pytest.approx([9.0 + gear_kg])
    assert tuning.shares == pytest.approx([0.1 * (10.0 + gear_kg)])


@pytest.mark.parametrize(
    ("dynamics", "said"),
    [
        ('friction="15"', []),
        ('friction="20"', ["its effort limit of 20 is not above its friction of 20; it will"]),
        ('damping="20"', []),
        (
            'damping="50" friction="5"',
            ["its effort limit of 20 moves it against its damping of 50 at 0.3 at most, far below"],
        ),
    ],
)
def test_joints_that_friction_or_damping_hold_back_are_named(parts, dynamics, said):
    found = [*weak_drives(*tuned(parts, parts.pendulum(f"<dynamics {dynamics}/>")))]
    assert len(found) == len(said)
    for (joint, problem), beginning in zip(found, said, strict=True):
        assert joint == "j"
        assert problem.startswith(beginning)


@pytest.fixture
def geared(parts):
    """Two sliders of 1 kg, of which 'b' moves 3 times as far as 'a' and has friction."""
    limit = 'lower="-1" upper="1" effort="5" velocity="1"'
    follows = '<mimic joint="a" multiplier="-3"/><dynamics damping="0.1" friction="0.2"/>'
    return parts.robot(
        parts.link("base"),
        *(parts.link(name, 1.0) for name in ("left", "right")),
        parts.joint("a", "base", "left", "prismatic", "0 0 1", limit=limit),
        parts.joint("b", "base", "right", "prismatic", "0 0 1", limit=limit, more=follows),
        parts.ros2_control(["a"]),
    )


def test_leader_feels_friction_by_the_gearing_and_damping_by_its_square(parts, geared):
    model, _, tuning = tuned(parts, geared)
    friction, damping = resistance(model, tuning.coupling)
    assert friction == pytest.approx([0.6])
    assert damping == pytest.approx([0.9])


def test_robot_without_drives_needs_no_tuning(parts):
    _, joints, tuning = tuned(parts, parts.robot(parts.link("base", 1.0)))
    assert joints == []
    assert tuning.braking.shape == (0,)
