"""The order of the joints."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from arm_control.controllers.joint_state_broadcaster.controller import (
    QUANTITIES,
    StateCopy,
    plan_joint_states,
)

STANDARD = {quantity: quantity for quantity in QUANTITIES}


def interfaces(*joints: str) -> list[str]:
    return [f"{joint}/{quantity}" for joint in joints for quantity in QUANTITIES]


def test_without_order_or_filter_it_is_that_of_the_interfaces():
    plan = plan_joint_states(interfaces("b", "a"), quantity_of=STANDARD)
    assert plan.layout.joints == ("b", "a")


def test_with_a_filter_it_is_alphabetical_and_only_what_it_allows():
    plan = plan_joint_states(
        interfaces("c", "a", "imu", "b"), quantity_of=STANDARD, allowed_joints={"a", "b", "c", "d"}
    )
    assert plan.layout.joints == ("a", "b", "c")


def test_ordered_joints_keep_their_order_despite_the_filter():
    plan = plan_joint_states(
        interfaces("a", "b", "c"),
        quantity_of=STANDARD,
        ordered_joints=("c", "a"),
        allowed_joints={"a"},
    )
    assert plan.layout.joints == ("c", "a")


def test_positions_come_before_velocities_before_efforts():
    plan = plan_joint_states(interfaces("a", "b"), quantity_of=STANDARD)
    states = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    assert plan.joints.update(states).tolist() == [1.0, 4.0, 2.0, 5.0, 3.0, 6.0]
    assert plan.components.update(states).tolist() == states.tolist()


def test_missing_values_of_a_joint_are_nan():
    plan = plan_joint_states(["a/position", "b/velocity"], quantity_of=STANDARD)
    values = plan.joints.update(np.array([1.0, 2.0]))
    assert plan.layout.joints == ("a", "b")
    np.testing.assert_array_equal(values, [1.0, np.nan, np.nan, 2.0, np.nan, np.nan])


def test_components_without_a_joints_quantities_are_only_in_the_dynamic_message():
    plan = plan_joint_states(["imu/gyro.x", "a/position", "a/heat"], quantity_of=STANDARD)
    assert plan.layout.joints == ("a",)
    assert plan.layout.components == (("imu", ("gyro.x",)), ("a", ("position", "heat")))


def test_an_interface_may_go_by_another_name():
    plan = plan_joint_states(["a/measured"], quantity_of={"measured": "position"})
    assert plan.layout.components == (("a", ("position",)),)
    assert plan.joints.update(np.array([4.0]))[0] == 4.0


def test_extra_joints_come_last_at_zero():
    plan = plan_joint_states(["a/position"], quantity_of=STANDARD, extra_joints=("wheel", "a"))
    values = plan.joints.update(np.array([1.0]))
    assert plan.layout.joints == ("a", "wheel")
    np.testing.assert_array_equal(values, [1.0, 0.0, np.nan, 0.0, np.nan, 0.0])
    assert plan.layout.components[-1] == ("wheel", QUANTITIES)


def test_names_of_joints_may_hold_slashes():
    plan = plan_joint_states(["left/a/position"], quantity_of=STANDARD)
    assert plan.layout.joints == ("left/a",)


@given(
    st.lists(
        st.one_of(st.integers(0, 9), st.floats(allow_nan=False, allow_infinity=False)), max_size=20
    )
)
def test_a_copy_takes_states_and_keeps_fixed_values(sources):
    states = np.arange(100.0, 110.0)
    copy = StateCopy(sources)
    expected = [100.0 + s if isinstance(s, int) else s for s in sources]
    assert copy.update(states).tolist() == expected
    assert copy.update(states).tolist() == expected


def test_gather_hands_out_the_same_array():
    copy = StateCopy([0, 1])
    first = copy.update(np.zeros(2))
    assert copy.update(np.ones(2)) is first


@pytest.mark.parametrize("empty", [[], ["imu/gyro.x"]])
def test_a_robot_without_joints_has_an_empty_message(empty):
    plan = plan_joint_states(empty, quantity_of=STANDARD)
    assert plan.layout.joints == ()
    assert plan.joints.update(np.zeros(len(empty))).size == 0
