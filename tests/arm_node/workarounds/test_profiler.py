import mujoco
import pytest

from arm_node.workarounds.profiler import switch_off_profiler

pytestmark = pytest.mark.workaround("profiler")

FALLING = "<mujoco><worldbody><body><freejoint/><geom size='0.1'/></body></worldbody></mujoco>"


@pytest.fixture
def time_of_steps():
    model = mujoco.MjModel.from_xml_string(FALLING)

    def measure():
        data = mujoco.MjData(model)
        mujoco.mj_step(model, data, 50)
        return data.timer[mujoco.mjtTimer.mjTIMER_STEP].duration

    return measure


def test_steps_take_no_times_once_it_is_off(time_of_steps):
    mujoco.set_mjcb_time(lambda: 1.0)
    mujoco.set_mjcb_time(None)
    assert time_of_steps() > 0.0, "MuJoCo's Python package gives it no clock any more"
    switch_off_profiler(mujoco)
    assert time_of_steps() == 0.0


def test_switching_it_off_twice_does_no_harm(time_of_steps):
    switch_off_profiler(mujoco)
    switch_off_profiler(mujoco)
    assert time_of_steps() == 0.0
