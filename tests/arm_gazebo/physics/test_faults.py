"""Faults of joints and sensors in the physics."""

from math import isnan

import mujoco
import numpy as np
import pytest

from arm_gazebo.physics.faults import Distortion, PhysicsFaults

SLIDER = """
<mujoco><option gravity="0 0 0"/><worldbody><body name="b"><joint name="{name}" type="slide"/>
<geom size="0.1"/></body></worldbody></mujoco>
"""


@pytest.fixture
def model() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(SLIDER.format(name="rail"))


@pytest.fixture
def faults(model) -> PhysicsFaults:
    return PhysicsFaults(model, lambda name: 0)


def pushed(model: mujoco.MjModel) -> float:
    """How far 100 N move the body in a second."""
    data = mujoco.MjData(model)
    data.qfrc_applied[0] = 100.0
    for _ in range(500):
        mujoco.mj_step(model, data)
    return float(data.qpos[0])


def test_a_stalled_joint_does_not_move(model, faults):
    before = pushed(model)
    faults.stall("rail")
    assert abs(pushed(model)) < 1e-3 < before
    faults.stall("rail")
    faults.free("rail")
    assert pushed(model) == before


def test_another_model_has_the_same_stalled_joint(model, faults):
    faults.stall("rail")
    other = mujoco.MjModel.from_xml_string(SLIDER.format(name="rail"))
    faults.rebind(other)
    assert abs(pushed(other)) < 1e-3
    faults.free("rail")
    assert pushed(other) > 0.1


def applied(faults: PhysicsFaults, value: float, number: int = 0) -> list[float]:
    readings = np.array([value, value, value])
    faults.apply(("a/x", "a/y", "ab/x"), readings, number)
    return readings.tolist()


def test_only_the_channels_of_that_name_are_wrong(faults):
    faults.distort("a", Distortion.NAN, 0.0, 0)
    assert list(map(isnan, applied(faults, 1.0))) == [True, True, False]
    faults.clear("a", Distortion.NAN)
    faults.distort("a/y", Distortion.NAN, 0.0, 0)
    assert list(map(isnan, applied(faults, 1.0))) == [False, True, False]


def test_a_frozen_channel_keeps_the_first_reading_until_the_fault_ends(faults):
    faults.distort("a/x", Distortion.FROZEN, 0.0, 0)
    assert applied(faults, 1.0)[0] == 1.0
    assert applied(faults, 2.0) == [1.0, 2.0, 2.0]
    faults.clear("a/x", Distortion.FROZEN)
    faults.distort("a/x", Distortion.FROZEN, 0.0, 0)
    assert applied(faults, 3.0)[0] == 3.0


def test_noise_is_of_the_state_the_channel_and_the_seed(faults):
    faults.distort("a", Distortion.NOISY, 0.1, 5)
    first = applied(faults, 0.0, 1)
    assert first == applied(faults, 0.0, 1)
    assert first[0] != first[1]
    assert first[2] == 0.0
    assert first[0] != applied(faults, 0.0, 2)[0]
    faults.clear("a", Distortion.NOISY)
    faults.distort("a", Distortion.NOISY, 0.1, 6)
    assert first[0] != applied(faults, 0.0, 1)[0]
