"""PID control of several joints."""

import numpy as np
import pytest

from arm_control.controllers.pid import AntiWindup, Pid, PidGains

DT = 0.1


def run(gains: PidGains, errors: list[float], rate: float = 0.0) -> list[float]:
    """Return the outputs for errors, one each 0.1 s."""
    pid = Pid([gains])
    return [float(pid.update(np.array([e]), np.array([rate]), DT)[0]) for e in errors]


def test_proportional_and_derivative():
    assert run(PidGains(p=2.0, d=3.0), [1.0], rate=0.5) == [3.5]


def test_integral_includes_the_present_error():
    assert run(PidGains(i=2.0), [1.0, 1.0, -1.0]) == pytest.approx([0.2, 0.4, 0.2])


def test_each_joint_has_its_own_gains():
    pid = Pid([PidGains(p=1.0), PidGains(p=10.0), PidGains(i=1.0)])

    assert pid.update(np.ones(3), np.zeros(3), DT) == pytest.approx([1.0, 10.0, 0.1])


def test_output_is_bounded():
    assert run(PidGains(p=1.0, u_max=2.0, u_min=-1.0), [5.0, -5.0]) == [2.0, -1.0]


def test_legacy_clamps_what_the_integral_contributes_not_the_integral():
    gains = PidGains(i=10.0, i_max=1.5, i_min=-1.5)

    assert run(gains, [1.0, 1.0, 1.0, -1.0]) == pytest.approx([1.0, 1.5, 1.5, 1.5])
    assert run(gains, [1.0, 1.0, 1.0, -1.0, -1.0])[-1] == pytest.approx(1.0)


def test_conditional_integration_stops_while_saturated():
    gains = PidGains(p=1.0, i=10.0, u_max=2.0, anti_windup=AntiWindup.CONDITIONAL_INTEGRATION)

    # 1 + 0, 1 + 1, 1 + 2 is too much; the integral stays at 2 until the error turns.
    assert run(gains, [1.0, 1.0, 1.0, 1.0, -1.0, -1.0]) == pytest.approx(
        [1.0, 2.0, 2.0, 2.0, 1.0, 0.0]
    )


def test_back_calculation_pulls_the_integral_back():
    gains = PidGains(
        p=1.0,
        i=10.0,
        u_max=1.0,
        anti_windup=AntiWindup.BACK_CALCULATION,
        tracking_time_constant=0.1,
    )

    # The integral is pulled to where the output is just not saturated, then grows by 1.
    assert run(gains, [1.0, 1.0, 1.0, -1.0]) == pytest.approx([1.0, 1.0, 1.0, 0.0])


def test_none_lets_the_integral_run():
    gains = PidGains(i=10.0, u_max=1.0, i_max=0.1, anti_windup=AntiWindup.NONE)

    assert run(gains, [1.0, 1.0, 1.0, 0.0]) == pytest.approx([0.0, 1.0, 1.0, 1.0])


def test_strategies_mix():
    pid = Pid([PidGains(i=1.0), PidGains(i=1.0, anti_windup=AntiWindup.NONE)])
    outputs = [pid.update(np.ones(2), np.zeros(2), DT).tolist() for _ in range(2)]

    assert outputs == [pytest.approx([0.1, 0.0]), pytest.approx([0.2, 0.1])]


@pytest.mark.parametrize("anti_windup", list(AntiWindup))
def test_an_error_within_the_deadband_is_not_integrated(anti_windup):
    gains = PidGains(i=1.0, error_deadband=0.5, anti_windup=anti_windup)

    assert run(gains, [0.5, -0.4, 0.3, 0.0]) == [0.0] * 4


def test_a_broken_sensor_does_not_spoil_the_integral():
    outputs = run(PidGains(i=1.0), [1.0, np.nan, 1.0])

    assert outputs[-1] == pytest.approx(0.2)


def test_gains_can_change_under_way():
    pid = Pid([PidGains(i=1.0)])
    pid.update(np.ones(1), np.zeros(1), DT)
    pid.set_gains([PidGains(p=1.0, i=1.0)])

    assert pid.update(np.ones(1), np.zeros(1), DT) == pytest.approx([1.2])


def test_the_time_constant_of_back_calculation_follows_from_the_gains():
    def last(gains: PidGains) -> float:
        return run(gains, [1.0, 1.0, -0.1])[-1]

    for gains, time_constant in (
        ({"p": 1.0, "i": 4.0, "d": 1.0}, 0.5),
        ({"p": 1.0, "i": 4.0}, 0.25),
    ):
        common = {**gains, "u_max": 1.0, "anti_windup": AntiWindup.BACK_CALCULATION}
        derived = last(PidGains(**common))
        explicit = last(PidGains(**common, tracking_time_constant=time_constant))
        assert derived == pytest.approx(explicit)
