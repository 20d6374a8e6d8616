"""Parameters: names, defaults, refused values, and the requested interfaces."""

from typing import Any

import pytest

from arm_control.controllers.joint_trajectory.controller import JointTrajectoryController
from arm_control.controllers.joint_trajectory.parameters import JointTrajectoryParameters
from arm_control.errors import ControllerError, ParameterError
from arm_control.parameters import build_parameters, specs_of

JOINTS = ("j0", "j1", "j2")
INF = float("inf")


def specs() -> dict[str, Any]:
    return {
        spec.name: spec for spec in JointTrajectoryController.parameter_specs({"joints": ["a"]})
    }


def test_parameters_of_each_joint_are_found_by_its_name():
    parameters = build_parameters(
        JointTrajectoryParameters, {"joints": JOINTS, "gains.j1.p": 3.0, "constraints.j2.goal": 0.5}
    )

    assert parameters.gains_of("j1").p == 3.0
    assert parameters.gains_of("j0").p == 0.0
    assert parameters.constraints_of("j2").goal == 0.5


@pytest.mark.parametrize("joints", [5, True, "j0"])
def test_joints_that_are_not_a_list_are_refused_in_a_sentence(joints):
    given = {"joints": joints}
    assert "joints" in {spec.name for spec in specs_of(JointTrajectoryParameters, given=given)}
    with pytest.raises(ParameterError, match=f"'joints' must be a list, not {joints!r}"):
        build_parameters(JointTrajectoryParameters, given)


@pytest.mark.parametrize(
    ("name", "default", "read_only"),
    [
        ("joints", (), True),
        ("command_joints", (), True),
        ("command_interfaces", (), True),
        ("state_interfaces", (), True),
        ("allow_partial_joints_goal", False, False),
        ("open_loop_control", False, True),
        ("interpolate_from_desired_state", False, True),
        ("allow_integration_in_goal_trajectories", False, False),
        ("set_last_command_interface_value_as_state_on_activation", True, False),
        ("action_monitor_rate", 20.0, True),
        ("interpolation_method", "splines", True),
        ("allow_nonzero_velocity_at_trajectory_end", False, False),
        ("cmd_timeout", 0.0, False),
        ("speed_scaling.initial_scaling_factor", 1.0, True),
        ("speed_scaling.state_interface", "", True),
        ("speed_scaling.command_interface", "", True),
        ("constraints.stopped_velocity_tolerance", 0.01, False),
        ("constraints.goal_time", 0.0, False),
        ("constraints.decelerate_on_cancel", False, True),
        ("constraints.a.trajectory", 0.0, False),
        ("constraints.a.goal", 0.0, False),
        ("constraints.a.max_deceleration_on_cancel", 0.0, True),
        ("gains.a.p", 0.0, False),
        ("gains.a.i", 0.0, False),
        ("gains.a.d", 0.0, False),
        ("gains.a.i_clamp", INF, False),
        ("gains.a.i_clamp_max", INF, False),
        ("gains.a.i_clamp_min", -INF, False),
        ("gains.a.u_clamp_max", INF, False),
        ("gains.a.u_clamp_min", -INF, False),
        ("gains.a.ff_velocity_scale", 0.0, False),
        ("gains.a.antiwindup_strategy", "legacy", True),
        ("gains.a.tracking_time_constant", 0.0, False),
        ("gains.a.error_deadband", 0.0, False),
        ("reject_with_reason", False, False),
        ("check_position_limits", False, False),
        ("check_velocity_limits", False, False),
        ("smooth_replacement_time", 0.0, False),
    ],
)
def test_every_parameter(name, default, read_only):
    assert specs()[name].default == default
    assert specs()[name].read_only is read_only


def test_there_are_no_others():
    assert len(specs()) == 38


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"action_monitor_rate": 0.05}, "'action_monitor_rate' must be at least 0.1"),
        ({"constraints.goal_time": -1.0}, "'constraints.goal_time' must be at least 0"),
        ({"cmd_timeout": -1.0}, "'cmd_timeout' must be at least 0"),
        ({"smooth_replacement_time": INF}, "'smooth_replacement_time' must be"),
        ({"interpolation_method": "cubic"}, "must be one of splines, none, but"),
        ({"gains.j0.antiwindup_strategy": "magic"}, "must be one of legacy, none,"),
        ({"gains.j0.u_clamp_min": 3.0, "gains.j0.u_clamp_max": 2.0}, "above u_clamp_max 2"),
        ({"gains.j0.i_clamp": -1.0}, r"leave no range for the integral: 1 to -1"),
        (
            {"gains.j0.i_clamp_min": 5.0, "gains.j0.i_clamp_max": 1.0},
            r"leave no range for the integral: 5 to 1",
        ),
        ({"gains.j0.q": 3.0}, "under 'gains.j0': unknown parameter q"),
        ({"gains.j9.p": 3.0}, "unknown parameter gains.j9.p"),
        ({"constraints.j0.goal": "near"}, "under 'constraints.j0': parameter 'goal' must be"),
    ],
)
def test_values_that_cannot_be(values, words):
    with pytest.raises(ParameterError, match=words):
        build_parameters(JointTrajectoryParameters, {"joints": JOINTS, **values})


def test_a_refused_change_leaves_the_old_ones(make_rig):
    rig = make_rig(cmd_timeout=1.0)
    with pytest.raises(ParameterError):
        rig.set(cmd_timeout=-1.0)
    rig.tick()

    assert rig.commanded().tolist() == [0.0, 0.0, 0.0]


class TestInterfaces:
    def test_are_claimed_joint_by_joint(self, make_rig):
        controller = make_rig(commands=("position", "velocity")).controller

        assert controller.command_interface_configuration().names[:3] == (
            "j0/position",
            "j0/velocity",
            "j1/position",
        )
        assert controller.state_interface_configuration().names[:3] == (
            "j0/position",
            "j0/velocity",
            "j1/position",
        )

    def test_command_joints_may_have_other_names(self, make_rig):
        controller = make_rig(command_joints=("m0", "m1", "m2"), activate=False).controller

        assert controller.command_interface_configuration().names == (
            "m0/position",
            "m1/position",
            "m2/position",
        )

    @pytest.mark.parametrize(
        ("parameters", "words"),
        [
            ({"joints": ()}, "'joints' parameter is empty"),
            ({"joints": ("j0", "j0")}, "names a joint twice"),
            ({"command_joints": ("a", "b", "c", "d")}, "more than the 3 of 'joints'"),
            ({"command_joints": ("j0", "j9")}, "unknown: j9"),
            ({"commands": ()}, "'command_interfaces' parameter is empty"),
            ({"commands": ("bad_name",)}, r"'command_interfaces' is \[bad_name\]; it may be"),
            ({"commands": ("effort", "velocity")}, "it may be"),
            ({"commands": ("velocity", "acceleration")}, "it may be"),
            ({"commands": ("acceleration",)}, "it may be"),
            ({"commands": ("position", "position")}, "it may be"),
            ({"states": ()}, "'state_interfaces' parameter is empty"),
            ({"states": ("effort",)}, "it may be"),
            ({"states": ("velocity",)}, "it may be"),
            ({"states": ("velocity", "acceleration")}, "it may be"),
            ({"commands": ("velocity",), "states": ("position",)}, "'velocity' command interface"),
            ({"commands": ("effort",), "states": ("position",)}, "'effort' command interface"),
            (
                {"commands": ("effort", "position"), "states": ("position",)},
                "'effort' command interface",
            ),
        ],
    )
    def test_incorrect_initialization_using_interface_parameters(self, make_rig, parameters, words):
        with pytest.raises(ControllerError, match=words):
            make_rig(activate=False, **parameters)
