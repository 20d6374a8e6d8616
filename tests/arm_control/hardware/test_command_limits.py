"""Commands that are kept within the limits of their joints."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from arm_control import ControllerManager, SwitchRequest
from arm_control.hardware.command_limits import CommandLimiter
from arm_control.hardware.joint_limits import JointLimits, SoftLimits
from arm_control.hardware.resource_manager import ResourceManager
from arm_control.testing import fake_hardware

PERIOD_S = 0.01
KINDS = ("position", "velocity", "effort", "acceleration", "jerk")
LIMITS = JointLimits(-1.0, 1.0, 2.0, 5.0)
SOFT = JointLimits(-1.0, 1.0, 2.0, 5.0, soft=SoftLimits(-0.8, 0.8, 10.0, 3.0))


class Plant:
    """One joint or several with the same limits, commanded by one kind of interface."""

    def __init__(self, kind: str, *limits: JointLimits, states: tuple[str, ...] = KINDS[:2]):
        joints = [f"j{i}" for i in range(len(limits))]
        hardware = fake_hardware(joints, command_interfaces=[kind], state_interfaces=states)
        self.resources = ResourceManager([hardware], 100)
        self.limiter = CommandLimiter(dict(zip(joints, limits, strict=True)), self.resources)
        self.names = [f"{joint}/{kind}" for joint in joints]
        self.limiter.claimed(self.names)

    def be(self, *states: float) -> None:
        """Set the states, joint by joint."""
        self.resources.states[:] = states

    def command(self, *values: float, period_s: float = PERIOD_S) -> Any:
        """Return the clamped commands."""
        self.resources.commands[:] = values
        self.limiter.enforce(period_s)
        limited = self.resources.commands.tolist()
        return limited[0] if len(limited) == 1 else limited


def test_a_position_stays_between_the_bounds():
    plant = Plant("position", JointLimits(-1.0, 1.0))
    plant.be(0.0, 0.0)
    assert [plant.command(x) for x in (-5.0, 0.5, 5.0)] == [-1.0, 0.5, 1.0]


def test_a_position_moves_no_faster_than_the_joint_may():
    plant = Plant("position", LIMITS)
    plant.be(0.5, 0.0)
    assert plant.command(0.0) == pytest.approx(0.48)
    assert plant.command(0.0) == pytest.approx(0.46)
    assert plant.command(0.455) == pytest.approx(0.455)


def test_changes_are_limited_from_the_last_command_not_the_lagging_state():
    plant = Plant("position", LIMITS)
    plant.be(0.0, 0.0)
    for _ in range(10):
        reached = plant.command(1.0)
    assert reached == pytest.approx(0.2)


def test_a_joint_at_rest_gathers_speed_as_its_acceleration_allows():
    plant = Plant("position", JointLimits(-1.0, 1.0, 2.0, acceleration=10.0))
    plant.be(0.0, 0.0)
    assert plant.command(1.0) == pytest.approx(10.0 * PERIOD_S**2)
    plant.be(0.0, 1.0)
    assert plant.command(1.0) == pytest.approx(10.0 * PERIOD_S**2 + 1.1 * PERIOD_S)


def test_a_newly_claimed_joint_starts_at_its_position():
    plant = Plant("position", LIMITS)
    plant.be(0.0, 0.0)
    plant.command(0.0)
    plant.limiter.claimed(())
    plant.be(0.9, 0.0)
    plant.limiter.claimed(plant.names)
    assert plant.command(0.9) == pytest.approx(0.9)


def test_unclaimed_commands_are_not_limited():
    plant = Plant("position", LIMITS, LIMITS)
    plant.be(0.0, 0.0, 0.0, 0.0)
    plant.limiter.claimed(("j0/position",))
    assert plant.command(9.0, 9.0) == [pytest.approx(0.02), 9.0]


def test_after_a_cycle_without_a_command_the_last_one_is_still_used():
    plant = Plant("position", LIMITS)
    plant.be(0.0, 0.0)
    for _ in range(5):
        plant.command(1.0)
    assert math.isnan(plant.command(math.nan))
    assert plant.command(1.0) == pytest.approx(0.12)


def test_without_a_state_the_first_command_is_only_bounded():
    plant = Plant("position", LIMITS, states=("effort",))
    plant.be(math.nan)
    assert plant.command(7.0) == 1.0
    assert plant.command(0.0) == pytest.approx(0.98)


def test_a_velocity_stays_below_the_limit_and_stops_at_the_bounds():
    plant = Plant("velocity", LIMITS)
    plant.be(0.0, 0.0)
    assert [plant.command(v) for v in (-9.0, 1.5, 9.0)] == [-2.0, 1.5, 2.0]
    plant.be(0.995, 0.0)
    assert plant.command(9.0) == pytest.approx(0.5)
    plant.be(1.2, 0.0)
    assert [plant.command(v) for v in (9.0, -9.0)] == [0.0, -2.0]


def test_a_velocity_changes_as_the_acceleration_allows_unless_a_bound_is_near():
    plant = Plant("velocity", JointLimits(-1.0, 1.0, 2.0, acceleration=10.0))
    plant.be(0.0, 0.3)
    assert plant.command(2.0) == pytest.approx(0.4)
    assert plant.command(2.0) == pytest.approx(0.5)
    assert plant.command(-2.0) == pytest.approx(0.4)
    plant.be(1.0, 0.4)
    assert plant.command(2.0) == 0.0


@pytest.mark.parametrize(
    ("position", "velocity", "expected"),
    [
        (0.0, 0.0, (-5.0, 5.0)),
        (1.0, 0.0, (-5.0, 0.0)),
        (1.0, -0.1, (-5.0, 5.0)),
        (-1.1, 0.0, (0.0, 5.0)),
        (0.0, 2.5, (-5.0, 0.0)),
        (0.0, -2.5, (0.0, 5.0)),
        (math.nan, math.nan, (-5.0, 5.0)),
    ],
)
def test_an_effort_never_pushes_outwards(position, velocity, expected):
    plant = Plant("effort", LIMITS)
    plant.be(position, velocity)
    assert (plant.command(-99.0), plant.command(99.0)) == expected


@pytest.mark.parametrize(("kind", "bound"), [("acceleration", 6.0), ("jerk", 7.0)])
def test_accelerations_and_jerks_have_bounds(kind, bound):
    plant = Plant(kind, JointLimits(acceleration=6.0, jerk=7.0))
    assert [plant.command(v) for v in (-99.0, 1.0, 99.0)] == [-bound, 1.0, bound]


def test_a_soft_bound_is_approached_ever_more_slowly_and_never_passed():
    plant = Plant("position", SOFT)
    plant.be(0.0, 0.0)
    path = [plant.command(1.0) for _ in range(200)]
    steps = np.diff(path)
    assert steps[:20] == pytest.approx(0.02)
    assert (np.diff(steps) <= 1e-12).all()
    assert max(path) <= 0.8
    assert path[-1] == pytest.approx(0.8, abs=1e-4)


def test_beyond_a_soft_bound_a_joint_may_only_move_back():
    plant = Plant("position", SOFT)
    plant.be(0.9, 0.0)
    assert plant.command(1.0) == pytest.approx(0.9)
    assert plant.command(0.0) == pytest.approx(0.88)
    velocity = Plant("velocity", SOFT)
    velocity.be(0.9, 0.0)
    assert [velocity.command(v) for v in (1.0, -1.0)] == [0.0, -1.0]


def test_a_soft_bound_without_a_gain_is_a_plain_bound():
    plant = Plant("position", JointLimits(-1.0, 1.0, 2.0, soft=SoftLimits(-0.8, 0.8, 0.0, 0.0)))
    plant.be(0.77, 0.0)
    assert plant.command(1.0) == pytest.approx(0.79)
    assert plant.command(1.0) == pytest.approx(0.8)


def test_a_joint_too_fast_for_its_soft_limits_is_braked():
    plant = Plant("effort", SOFT)
    plant.be(0.75, 1.5)
    # At 0.05 rad from the bound 0.5 rad/s are allowed: 3 N m per rad/s brake the other 1.0.
    assert plant.command(5.0) == pytest.approx(-3.0)


def test_each_joint_has_its_own_limits():
    plant = Plant("position", JointLimits(-1.0, 1.0), JointLimits(), SOFT)
    plant.be(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    assert plant.command(3.0, 3.0, 3.0) == [1.0, 3.0, pytest.approx(0.02)]


numbers = st.floats(-50.0, 50.0) | st.sampled_from([math.nan, math.inf, -math.inf])
bounds = st.floats(0.01, 20.0) | st.just(math.inf)


@st.composite
def joint_limits(draw: Any) -> JointLimits:
    """Draw limits: any may be missing, and soft ones may be anywhere."""
    lower, upper = sorted((draw(st.floats(-5.0, 5.0)), draw(st.floats(-5.0, 5.0))))
    soft = sorted((draw(st.floats(-6.0, 6.0)), draw(st.floats(-6.0, 6.0))))
    if draw(st.booleans()):
        lower, upper = -math.inf, math.inf
    gains = st.floats(0.0, 500.0)
    return JointLimits(
        lower,
        upper,
        draw(bounds),
        draw(bounds),
        draw(bounds),
        draw(bounds),
        soft=SoftLimits(soft[0], soft[1], draw(gains), draw(gains)),
    )


@settings(max_examples=300)
@given(
    st.sampled_from(KINDS),
    joint_limits(),
    st.lists(st.tuples(numbers, numbers, numbers), min_size=1, max_size=6),
)
def test_no_command_ever_leaves_the_limits(kind, limits, story):
    plant = Plant(kind, limits)
    low, high = {
        "position": (limits.lower, limits.upper),
        "velocity": (-limits.velocity, limits.velocity),
        "effort": (-limits.effort, limits.effort),
        "acceleration": (-limits.acceleration, limits.acceleration),
        "jerk": (-limits.jerk, limits.jerk),
    }[kind]
    for position, velocity, command in story:
        plant.be(position, velocity)
        limited = plant.command(command)
        if math.isnan(command):
            assert math.isnan(limited)
        else:
            assert low <= limited <= high


@settings(max_examples=300)
@given(
    st.sampled_from(KINDS),
    joint_limits(),
    st.floats(-5.0, 5.0),
    st.floats(-20.0, 20.0),
    st.lists(st.floats(-50.0, 50.0), min_size=2, max_size=8),
    st.floats(-5.0, 5.0),
)
def test_a_higher_command_never_becomes_a_lower_one(
    kind, limits, position, velocity, commands, previous
):
    limited = []
    for command in sorted(commands):
        plant = Plant(kind, limits)
        plant.be(position, velocity)
        plant.command(previous)
        limited.append(plant.command(command))
    assert limited == sorted(limited)


@given(joint_limits(), st.floats(-1.0, 1.0), st.lists(st.floats(-50.0, 50.0), max_size=30))
def test_within_the_bounds_no_step_is_larger_than_the_speed_limit(limits, share, commands):
    plant = Plant("position", limits)
    start = (
        share
        if math.isinf(limits.lower)
        else limits.lower + ((limits.upper - limits.lower) * (share + 1.0) / 2.0)
    )
    plant.be(start, 0.0)
    last = start
    for command in commands:
        now = plant.command(command)
        assert abs(now - last) <= limits.velocity * PERIOD_S * (1 + 1e-9) + 1e-12
        last = now


def test_a_command_within_the_limits_is_not_touched():
    plant = Plant("position", *[LIMITS] * 4)
    plant.be(*[0.1, 0.0] * 4)
    commands = [0.1, 0.10001, 0.09, 0.1199]
    assert plant.command(*commands) == commands


def test_a_manager_keeps_its_controllers_commands_within_the_limits(bench):
    names = ("j0", "j1", "j2", "j3")
    bench.hardware = fake_hardware(names)
    bench.manager = ControllerManager([bench.hardware], 100, limits=dict.fromkeys(names, LIMITS))
    bench.manager.bring_up()
    probe = bench.configure("a", commands=tuple(f"{name}/position" for name in names))
    bench.manager.switch_controller(SwitchRequest(("a",)))
    probe.commands.write(0.5)
    bench.tick()
    assert bench.hardware.commands.tolist() == pytest.approx([0.02] * 4)
    probe.commands.write(math.nan)
    bench.tick()
    assert np.isnan(bench.hardware.commands).all()


def test_without_limits_a_manager_leaves_commands_alone(bench):
    probe = bench.configure("a", commands=("j0/position",))
    bench.manager.switch_controller(SwitchRequest(("a",)))
    probe.commands.write(99.0)
    bench.tick()
    assert bench.hardware.commands[0] == 99.0
