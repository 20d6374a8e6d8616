"""Which bodies have touched each other, and when."""

import mujoco
import pytest

from arm_sim.bench.touches import TouchLog

BALL = """
<mujoco><worldbody>
  <geom type="plane" size="1 1 1"/>
  <body name="ball" pos="0 0 0.2"><freejoint/><geom type="sphere" size="0.1"/></body>
</worldbody></mujoco>
"""


@pytest.fixture
def data() -> mujoco.MjData:
    return mujoco.MjData(mujoco.MjModel.from_xml_string(BALL))


def run(log: TouchLog, data: mujoco.MjData, steps: int) -> None:
    for _ in range(steps):
        mujoco.mj_step(data.model, data)
        log.note(data.time, data)


def test_a_touch_is_noted_with_its_time(data):
    log = TouchLog()
    run(log, data, 500)
    (touch,) = log.touches
    assert touch.bodies == ("ball", "world")
    # It falls through 0.1 m.
    assert touch.began_s == pytest.approx(0.143, abs=0.005)
    assert touch.ended_s == data.time
    assert log.present == (touch,)


def test_a_touch_ends(data):
    log = TouchLog()
    run(log, data, 300)
    end_s = data.time
    data.qpos[2] = 0.5
    data.qvel[:] = 0.0
    run(log, data, 10)
    assert log.present == ()
    assert log.touches[0].ended_s == pytest.approx(end_s)
    assert str(log.touches[0]).startswith("ball touches world from 0.14")


def test_bodies_that_sleep_still_touch():
    sleeping = BALL.replace("<worldbody>", '<option><flag sleep="enable"/></option><worldbody>')
    data = mujoco.MjData(mujoco.MjModel.from_xml_string(sleeping))
    log = TouchLog()
    run(log, data, 2000)
    assert data.ncon == 0
    (touch,) = log.present
    assert touch.ended_s == data.time


def test_a_new_touch_of_the_same_bodies_is_another_one(data):
    log = TouchLog()
    run(log, data, 300)
    data.qpos[2] = 0.3
    run(log, data, 300)
    assert len(log.touches) == 2
