"""State interfaces and sensor readings."""

import pytest
from robots import pendulum, sensor

from arm_sim import Simulation, UnknownNameError

IMU = pendulum(sensor("bob", "imu", "imu", "<always_on>1</always_on>"), name="box")


def test_states_are_those_that_controllers_read(sim):
    sim["position_controller"].command([0.5, 0.0, 0.0, 0.0])
    sim.run(1.0)
    assert sim.states["j0/position"] == sim.joints["j0"].position
    assert set(sim.states) >= {"j0/position", "j3/velocity", "j3/effort"}
    assert len(sim.states) == 12
    with pytest.raises(UnknownNameError, match="no state interface 'j9/position'; the hardware"):
        sim.states["j9/position"]


def test_a_sensor_is_read_by_its_channels(tmp_path):
    file = tmp_path / "box.urdf"
    file.write_text(IMU)
    with Simulation(file) as sim:
        sim.run(1.0)
        assert list(sim.sensors) == ["imu"]
        assert sim.sensors["imu"]["linear_acceleration.z"] == pytest.approx(9.81, abs=1e-3)
        with pytest.raises(UnknownNameError, match="no sensor 'x'; the robot has imu"):
            sim.sensors["x"]
