"""Whether a pose is reached, and why not."""

import pytest

from arm_controller.publisher_defined_node import shortfall

NAN = float("nan")


def missing(positions: dict[str, float]) -> str:
    return shortfall((1.0, -0.5), ("j0", "j1"), positions, 0.02)


@pytest.mark.parametrize(
    "positions", [{"j1": -0.5, "j0": 1.0}, {"j0": 1.015, "j1": -0.485, "grip": 7.0}]
)
def test_a_pose_is_reached_when_every_joint_is_within_the_tolerance(positions):
    assert missing(positions) == ""


@pytest.mark.parametrize(
    ("positions", "said"),
    [
        ({"j0": 1.021, "j1": -0.5}, "joint 'j0' is at 1.0210, 0.0210 from 1.0000 (tolerance 0.02)"),
        ({"j0": 0.9, "j1": 0.0}, "joint 'j1' is at 0.0000, 0.5000 from -0.5000 (tolerance 0.02)"),
        ({"a": 0.0, "j0": 1.0}, "no joint 'j1' in /joint_states, which has a, j0"),
        ({}, "/joint_states is silent: is the joint_state_broadcaster active?"),
        ({"j0": NAN, "j1": -0.5}, "the position of joint 'j0' in /joint_states is not a number"),
    ],
)
def test_else_it_names_the_joint_that_is_farthest_off(positions, said):
    assert missing(positions).startswith(said)
