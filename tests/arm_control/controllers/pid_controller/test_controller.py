"""The PID controller on fake hardware: alone, and behind another controller."""

from math import inf, nan, pi
from typing import Any

import numpy as np
import pytest
from manager_bench import PERIOD_S, ManagerBench

from arm_control import ControllerContext
from arm_control.controllers.forward_command.controller import (
    ForwardCommandController,
    ForwardCommandParameters,
)
from arm_control.controllers.joint_trajectory.controller import JointTrajectoryController
from arm_control.controllers.pid_controller.controller import STATE_FIELDS, PidController, PidTerms
from arm_control.errors import ControllerError, ControllerManagerError, ParameterError
from arm_control.testing import fake_hardware

DOFS = ["j0", "j1"]


class Sink:
    def __init__(self) -> None:
        self.states: list[np.ndarray] = []
        self.terms: list[tuple[int, PidTerms]] = []

    def publish(self, time_s: float, state: np.ndarray) -> None:
        self.states.append(state.copy())

    def publish_terms(self, time_s: float, dof: int, terms: PidTerms) -> None:
        self.terms.append((dof, terms))

    def last(self, field: str) -> list[float]:
        return self.states[-1][:, STATE_FIELDS.index(field)].tolist()


class PidBench(ManagerBench):
    """Two joints that do not move by themselves, and a PID controller."""

    def __init__(self) -> None:
        super().__init__(
            fake_hardware(
                ("j0", "j1"),
                command_interfaces=("effort",),
                state_interfaces=("position", "velocity"),
            )
        )
        self.pid = PidController(ControllerContext("pid", 100))
        self.pid.sink = self.sink = Sink()
        self.manager.load_controller(self.pid, "pid_controller/PidController")

    def configure(self, **values: Any) -> None:
        defaults = {
            "dof_names": DOFS,
            "command_interface": "effort",
            "reference_and_state_interfaces": ["position"],
            "gains.j0.p": 10.0,
            "gains.j1.p": 20.0,
        }
        merged = {name: v for name, v in {**defaults, **values}.items() if v is not None}
        self.given = merged
        self.manager.configure_controller("pid", PidController.build_parameters(merged))

    def change(self, **values: Any) -> None:
        self.pid.update_parameters(PidController.build_parameters({**self.given, **values}))

    def measure(self, positions: list[float], velocities: list[float] | None = None) -> None:
        states = self.hardware.states.reshape(2, 2)
        states[:, 0] = positions
        if velocities is not None:
            states[:, 1] = velocities

    def commands_after(self, ticks: int = 1) -> list[float]:
        self.tick(ticks)
        return self.hardware.commands.tolist()


@pytest.fixture
def bench() -> PidBench:
    return PidBench()


@pytest.fixture
def running(bench) -> PidBench:
    bench.configure(set_current_state_as_first_setpoint=False)
    bench.switch("pid")
    bench.measure([0.0, 0.0])
    return bench


def test_without_a_reference_it_commands_nothing(running):
    assert np.isnan(running.commands_after(3)).all()


def test_the_error_times_its_gain_is_commanded(running):
    running.measure([0.5, 0.5])
    assert not running.pid.offer(DOFS, [1.0, 1.0])
    assert running.commands_after() == [5.0, 10.0]


def test_the_terms_of_those_that_ask_for_it_are_published_at_any_time(running):
    running.measure([0.5, 0.5])
    running.pid.offer(DOFS, [1.0, 1.0])
    running.tick()
    assert running.sink.terms == []
    running.change(**{"gains.j1.activate_state_publisher": True, "gains.j1.i": 4.0})
    command = running.commands_after(2)
    (place, first), (_, last) = running.sink.terms
    assert (place, first.error, first.gains.p, first.period_s) == (1, 0.5, 20.0, PERIOD_S)
    assert last.integral == pytest.approx(2 * 4.0 * 0.5 * PERIOD_S)
    assert last.output == command[1]


def test_the_strategy_against_windup_may_change_at_any_time(running):
    bounded = {"gains.j0.p": 0.0, "gains.j0.i": 100.0, "gains.j0.u_clamp_max": 1.0}
    running.change(**bounded)
    running.pid.offer(DOFS, [1.0, 0.0])
    running.tick(100)
    assert running.pid.parameters.gains["j0"].antiwindup_strategy == "legacy"
    strategy = {"antiwindup_strategy": "back_calculation", "tracking_time_constant": 0.01}
    running.change(**bounded, **{f"gains.j0.{name}": value for name, value in strategy.items()})
    running.tick(2)
    running.measure([1.5, 0.0])
    # Legacy would take seconds to unwind.
    assert running.commands_after(10)[0] < 1.0


def test_names_may_come_in_any_order_or_not_at_all(running):
    assert not running.pid.offer(["j1", "j0"], [2.0, 1.0])
    assert running.commands_after() == [10.0, 40.0]
    assert not running.pid.offer([], [0.0, 1.0])
    assert running.commands_after() == [0.0, 20.0]


def test_a_nan_leaves_a_reference_as_it_is(running):
    running.pid.offer([], [1.0, nan])
    command = running.commands_after()
    assert command[0] == 10.0
    assert np.isnan(command[1])
    running.pid.offer([], [nan, 1.0])
    assert running.commands_after() == [10.0, 20.0]


@pytest.mark.parametrize(
    ("names", "values", "derivatives", "says"),
    [
        (["j0", "j9"], [0.0, 0.0], [], "it names j0, j9; the controller has j0, j1"),
        (["j0", "j0"], [0.0, 0.0], [], "it names j0, j0"),
        ([], [0.0], [], "it has 1 values and 0 derivatives; the controller has 2 degrees"),
        ([], [0.0, 0.0], [0.0], "2 values and 1 derivatives"),
        ([], [0.0, inf], [], "it has an infinite value"),
    ],
)
def test_references_that_make_no_sense_are_refused(running, names, values, derivatives, says):
    assert says in running.pid.offer(names, values, derivatives)
    assert np.isnan(running.commands_after()).all()


def test_references_and_states_are_refused_while_it_is_not_configured(bench):
    # Its topics begin after the core and end after it.
    assert bench.pid.offer(DOFS, [0.0, 0.0]) == "the controller is not configured"
    bench.configure()
    bench.manager.cleanup_controller("pid")
    assert bench.pid.offer(DOFS, [0.0, 0.0]) == "the controller is not configured"
    assert bench.pid.offer_measured(DOFS, [0.0, 0.0]) == "the controller is not configured"


def test_it_holds_the_position_at_its_activation(bench):
    bench.configure()
    bench.measure([0.5, -0.5])
    bench.switch("pid")
    assert bench.pid.references.tolist() == [0.5, -0.5]
    assert bench.commands_after() == [0.0, 0.0]
    bench.measure([0.4, -0.5])
    assert bench.commands_after() == pytest.approx([1.0, 0.0])


@pytest.mark.parametrize(("saved", "then"), [(True, 1.02), (False, 0.02)])
def test_the_integral_grows_and_may_outlast_a_deactivation(bench, saved, then):
    gains = {"gains.j0.p": 0.0, "gains.j0.i": 2.0, "gains.j1.p": 0.0, "gains.j1.i": 2.0}
    bench.configure(**gains, **{"gains.j0.save_i_term": saved, "gains.j1.save_i_term": False})
    bench.switch("pid")
    bench.measure([0.0, 0.0])
    bench.pid.offer([], [1.0, 1.0])
    assert bench.commands_after(50) == pytest.approx([1.0, 1.0])
    bench.switch("", "pid")
    assert bench.hardware.commands.tolist() == [0.0, 0.0]
    bench.switch("pid")
    bench.pid.offer([], [1.0, 1.0])
    assert bench.commands_after() == pytest.approx([then, 0.02])
    bench.switch("", "pid")
    bench.configure(**gains)
    bench.switch("pid")
    bench.pid.offer([], [1.0, 1.0])
    assert bench.commands_after() == pytest.approx([0.02, 0.02])


@pytest.mark.parametrize(("antiwindup", "held"), [(True, 0.48), (False, 0.5)])
def test_the_integral_itself_can_be_clamped(bench, antiwindup, held):
    bench.configure(
        **{"gains.j0.p": 0.0, "gains.j0.i": 2.0, "gains.j0.i_clamp_max": 0.5},
        **{"gains.j0.antiwindup": antiwindup, "gains.j1.p": 0.0},
    )
    bench.switch("pid")
    bench.measure([0.0, 0.0])
    bench.pid.offer([], [1.0, 0.0])
    assert bench.commands_after(50) == pytest.approx([0.5, 0.0])
    # What had been wound up beyond the bound has to be unwound first.
    bench.pid.offer([], [-1.0, 0.0])
    assert bench.commands_after() == pytest.approx([held, 0.0])


def test_one_interface_is_differentiated(bench):
    bench.configure(**{"gains.j0.p": 0.0, "gains.j1.p": 0.0, "gains.j0.d": 1.0})
    bench.switch("pid")
    bench.measure([0.0, 0.0])
    bench.pid.offer([], [1.0, 1.0])
    # Nothing to compare with yet.
    assert bench.commands_after() == [0.0, 0.0]
    bench.measure([0.1, 0.1])
    assert bench.commands_after() == pytest.approx([-10.0, 0.0])


def test_with_two_interfaces_the_second_is_the_derivative(bench):
    bench.configure(reference_and_state_interfaces=["position", "velocity"], **{"gains.j0.d": 3.0})
    assert bench.pid.reference_names() == (
        "j0/position",
        "j1/position",
        "j0/velocity",
        "j1/velocity",
    )
    bench.switch("pid")
    bench.measure([0.0, 0.0], [0.5, 0.5])
    bench.pid.offer([], [1.0, 1.0], [2.0, 2.0])
    assert bench.commands_after() == pytest.approx([10.0 + 3.0 * 1.5, 20.0])


def test_the_error_is_the_shortest_rotation(bench):
    bench.configure(**{"gains.j0.angle_wraparound": True})
    bench.switch("pid")
    bench.measure([3.0, 3.0])
    bench.pid.offer([], [-3.0, -3.0])
    assert bench.commands_after() == pytest.approx([10.0 * (2.0 * pi - 6.0), -120.0])


def test_feed_forward_adds_the_reference_when_it_is_on(bench):
    bench.configure(**{"gains.j0.feedforward_gain": 4.0})
    bench.switch("pid")
    bench.measure([1.0, 1.0])
    bench.pid.offer([], [1.0, 1.0])
    assert bench.commands_after() == [0.0, 0.0]
    bench.pid.enable_feedforward(True)
    assert bench.commands_after() == [4.0, 0.0]


def test_the_output_is_clamped(bench):
    bench.configure(**{"gains.j0.u_clamp_max": 1.5})
    bench.switch("pid")
    bench.measure([0.0, 0.0])
    bench.pid.offer([], [1.0, 1.0])
    assert bench.commands_after() == [1.5, 20.0]


def test_gains_can_change_while_it_runs(running):
    running.pid.offer([], [1.0, 1.0])
    values = {
        "dof_names": DOFS,
        "command_interface": "effort",
        "reference_and_state_interfaces": ["position"],
        "gains.j0.p": 1.0,
    }
    running.pid.update_parameters(PidController.build_parameters(values))
    assert running.commands_after() == [1.0, 0.0]


def test_states_may_come_by_topic(bench):
    bench.configure(use_external_measured_states=True)
    bench.switch("pid")
    bench.measure([9.0, 9.0])
    bench.pid.offer([], [1.0, 1.0])
    assert np.isnan(bench.commands_after()).all()
    assert not bench.pid.offer_measured(["j1", "j0"], [0.5, 0.0])
    assert bench.commands_after() == [10.0, 10.0]


def test_the_state_is_published(running):
    running.measure([0.25, 0.0])
    running.pid.offer([], [1.0, nan])
    running.tick()
    assert running.sink.last("reference")[0] == 1.0
    assert running.sink.last("feedback") == [0.25, 0.0]
    assert running.sink.last("error")[0] == 0.75
    assert running.sink.last("time_step") == [PERIOD_S, PERIOD_S]
    assert running.sink.last("output")[0] == 7.5


def test_behind_a_forward_command_controller(running):
    top = ForwardCommandController(ControllerContext("top", 100))
    running.manager.load_controller(top, "forward")
    joints = ("pid/j0", "pid/j1")
    running.manager.configure_controller("top", ForwardCommandParameters(joints, "position"))
    running.pid.offer([], [5.0, 5.0])
    running.switch("top")
    assert running.pid.is_chained
    top.offer([1.0, 2.0])
    running.measure([0.0, 0.5])
    assert running.commands_after() == [10.0, 30.0]
    statuses = {s.name: s for s in running.manager.list_controllers()}
    assert list(statuses) == ["top", "pid"]
    assert statuses["pid"].reference_interfaces == ("j0/position", "j1/position")
    # Alone again, it goes on to where it was sent; what came by topic meanwhile is too old.
    running.pid.offer([], [5.0, 5.0])
    running.switch("", "top")
    assert running.commands_after() == [10.0, 30.0]
    assert running.pid.exported_states.tolist() == [0.0, 0.5]


def test_behind_a_joint_trajectory_controller(running):
    running.switch("", "pid")
    running.measure([0.3, -0.4], [0.0, 0.0])
    leader = JointTrajectoryController(ControllerContext("jtc", 100))
    running.manager.load_controller(leader, "jtc")
    parameters = {
        "joints": DOFS,
        "command_joints": ["pid/j0", "pid/j1"],
        "command_interfaces": ["position"],
        "state_interfaces": ["position", "velocity"],
    }
    running.manager.configure_controller(
        "jtc", JointTrajectoryController.build_parameters(parameters)
    )
    running.switch("jtc pid")
    # It holds where the joints are.
    assert running.commands_after(2) == pytest.approx([0.0, 0.0])
    assert running.pid.references.tolist() == pytest.approx([0.3, -0.4])
    running.measure([0.2, -0.4])
    assert running.commands_after() == pytest.approx([1.0, 0.0])


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"dof_names": None}, "'dof_names' parameter was empty"),
        ({"command_interface": ""}, "'command_interface' parameter was empty"),
        ({"reference_and_state_interfaces": []}, "takes one interface, or two"),
        ({"reference_and_state_interfaces": ["a", "b", "c"]}, "derivative of the first, not 3"),
        ({"reference_and_state_dof_names": ["x"]}, "'dof_names' has 2 names, but .* has 1"),
    ],
)
def test_parameters_that_do_not_fit_fail_the_configuration(bench, values, says):
    gains = {"gains.j0.p": None, "gains.j1.p": None}
    with pytest.raises(ControllerManagerError, match=says):
        bench.configure(**gains, **values)


def test_reversed_bounds_are_refused():
    with pytest.raises(ParameterError, match=r"'gains\.j0\.u_clamp_min' is 2, above u_clamp_max 1"):
        PidController.build_parameters(
            {"dof_names": ["j0"], "gains.j0.u_clamp_min": 2.0, "gains.j0.u_clamp_max": 1.0}
        )


@pytest.mark.parametrize("names", [5, True, "j0"])
def test_names_that_are_not_a_list_are_refused_in_a_sentence(names):
    given = {"dof_names": names}
    assert "dof_names" in {spec.name for spec in PidController.parameter_specs(given)}
    with pytest.raises(ParameterError, match=f"'dof_names' must be a list, not {names!r}"):
        PidController.build_parameters(given)


def test_a_program_s_command_is_the_references(running):
    running.pid.take_command([1.0, 0.5])
    running.tick()
    assert running.hardware.commands.tolist() == pytest.approx([10.0, 10.0])
    with pytest.raises(ControllerError, match="a reference was dropped: it has 1 values"):
        running.pid.take_command([1.0])
