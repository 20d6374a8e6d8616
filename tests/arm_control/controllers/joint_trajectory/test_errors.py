"""Errors, and the PID controllers that act on them."""

import numpy as np
import pytest

START = (1.1, 2.1, 3.1)
POINTS = [[3.3, 4.4, 6.6], [7.7, 8.8, 9.9], [10.10, 11.11, 12.12]]
THREE_POINTS = [(0.25 * (i + 1), point) for i, point in enumerate(POINTS)]


def gains(**values: float) -> dict[str, float]:
    return {f"gains__j{i}__{name}": value for i in range(3) for name, value in values.items()}


class TestErrors:
    @pytest.mark.parametrize("joint_type", ["revolute", "continuous"])
    def test_position_error_angle_wraparound(self, make_rig, robot_description, joint_type):
        rig = make_rig(positions=START, robot_description=robot_description(joint_type))
        rig.moves = False
        rig.trajectory(THREE_POINTS)
        rig.tick()
        rig.run(0.25)

        difference = np.array(POINTS[0]) - START
        if joint_type == "continuous":
            difference[2] -= 2.0 * np.pi
        assert rig.sink.state.error[0] == pytest.approx(difference)
        assert rig.sink.state.reference[0] == pytest.approx(POINTS[0])

    def test_a_continuous_joint_takes_the_shortest_rotation(self, make_rig, robot_description):
        rig = make_rig(positions=(0.0, 0.0, 3.1), robot_description=robot_description("continuous"))
        rig.moves = False
        rig.trajectory([(1.0, [0.0, 0.0, 6.6])])
        rig.tick()
        rig.run(0.5)

        assert rig.sink.state.reference[1, 2] == pytest.approx(6.6 - 3.1 - 2.0 * np.pi)

    def test_the_pid_controller_of_a_continuous_joint_takes_the_shortest_rotation(
        self, make_rig, robot_description
    ):
        rig = make_rig(
            commands=("velocity",),
            positions=START,
            robot_description=robot_description("continuous"),
            **gains(p=10.0),
        )
        rig.moves = False
        rig.trajectory(THREE_POINTS)
        rig.tick()
        rig.run(0.25)

        assert rig.commanded("velocity") == pytest.approx(10.0 * rig.sink.state.error[0])
        assert rig.commanded("velocity")[2] < 0.0

    def test_velocity_error(self, make_rig, interfaces):
        commands, states = interfaces
        rig = make_rig(commands=commands, states=states)
        rig.moves = False
        rig.trajectory([(1.0, [1.0, 2.0, 3.0])])
        rig.tick(2)

        error = dict(zip(rig.sink.layout.error, rig.sink.state.error, strict=True))
        if "velocity" in error:
            counts = "velocity" in commands or "effort" in commands
            assert error["velocity"] == pytest.approx([1.0, 2.0, 3.0] if counts else [0.0] * 3)

    def test_state_topic_consistency(self, make_rig, interfaces):
        commands, states = interfaces
        rig = make_rig(commands=commands, states=states)
        rig.trajectory(THREE_POINTS)
        rig.tick(30)
        layout, state = rig.sink.layout, rig.sink.state

        order = ("position", "velocity", "acceleration", "effort")
        assert layout.reference == (order if "effort" in commands else order[:3])
        assert layout.feedback == layout.error == tuple(k for k in order if k in states)
        assert layout.output == tuple(kind for kind in order if kind in commands)
        for kind, row in zip(layout.output, state.output, strict=True):
            assert row.tolist() == rig.commanded(kind).tolist()
        rows = (*layout.reference, *layout.feedback, *layout.error, *layout.output)
        assert state.values.shape == (len(rows), 3)
        assert len(rig.sink.states) == 30


class TestPid:
    def test_use_closed_loop_pid(self, make_rig):
        rig = make_rig(commands=("effort",), positions=START, **gains(p=10.0))
        rig.moves = False
        rig.trajectory([(1.0, [2.1, 2.1, 2.1])])
        rig.tick(11)

        assert rig.commanded("effort") == pytest.approx([1.0, 0.0, -1.0])

    def test_velocity_feedforward(self, make_rig):
        rig = make_rig(commands=("velocity",), **gains(ff_velocity_scale=0.5))
        rig.moves = False
        rig.trajectory([(1.0, [1.0, 2.0, -3.0])])
        rig.tick()

        assert rig.commanded("velocity") == pytest.approx([0.5, 1.0, -1.5])

    def test_open_loop_velocities_are_handed_through(self, make_rig):
        rig = make_rig(commands=("velocity",), open_loop_control=True, **gains(p=99.0))
        rig.moves = False
        rig.trajectory([(1.0, [1.0, 2.0, -3.0])])
        rig.tick(50)

        assert rig.commanded("velocity") == pytest.approx([1.0, 2.0, -3.0])

    def test_effort_of_the_trajectory_is_added(self, make_rig):
        rig = make_rig(commands=("effort",))
        rig.moves = False
        rig.trajectory([(1.0, [0.0] * 3, (), (), [1.0, 2.0, 3.0]), (2.0, [0.0] * 3)])
        rig.tick()
        rig.run(1.0)

        assert rig.commanded("effort") == pytest.approx([1.0, 2.0, 3.0])

    def test_effort_beside_positions_is_handed_through(self, make_rig):
        rig = make_rig(commands=("position", "effort"), **gains(p=99.0))
        rig.moves = False
        rig.trajectory([(1.0, [1.0] * 3, (), (), [1.0, 2.0, 3.0]), (2.0, [1.0] * 3)])
        rig.tick()
        rig.run(1.0)

        assert rig.commanded("effort") == pytest.approx([1.0, 2.0, 3.0])

    def test_the_integral_is_reset_by_each_activation(self, make_rig):
        rig = make_rig(commands=("effort",), **gains(i=1.0))
        rig.moves = False
        rig.trajectory([(0.0, [1.0] * 3)])
        rig.run(1.0)
        assert rig.commanded("effort").min() > 0.9

        rig.deactivate()
        rig.activate()
        rig.tick()
        assert rig.commanded("effort").tolist() == [0.0, 0.0, 0.0]
