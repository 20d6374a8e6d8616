"""The simulation as a library: time, joints, controllers, and what goes wrong."""

import logging
import math
import os
import subprocess
import sys

import numpy as np
import pytest
from robots import pendulum

from arm_control.errors import (
    ArmControlError,
    ControllerError,
    RegistryError,
    UnhandledFailureError,
)
from arm_control.lifecycle import LifecycleState
from arm_description.errors import DescriptionError
from arm_gazebo.errors import WorldError
from arm_node.parameter_values import ParameterValueError
from arm_sim import CallError, Simulation, UnknownNameError

WITHOUT_ROS = """
import os, sys
from arm_sim import Simulation
with Simulation("arm") as sim:
    sim["position_controller"].command([0.1, 0.1, 0.1, 0.1])
    sim.run(0.1)
unneeded = {"rclpy", "std_msgs", "rcl_interfaces", "glfw", "trimesh", "cv2", "scipy"}
unneeded |= {"argparse", "difflib", "html", "json", "numpy.ma"}
print(sorted(unneeded & set(sys.modules)), os.environ.get("MUJOCO_GL"))
"""


def test_a_command_moves_the_joints(sim):
    sim["position_controller"].command([1.0, 0.5, 0.1, 0.5])
    sim.run(2.0)
    assert sim.joints.position == pytest.approx([1.0, 0.5, 0.1, 0.5], abs=1e-3)
    assert sim.joints["j0"].position == pytest.approx(1.0, abs=1e-3)
    assert abs(sim.joints["j1"].effort) > 0.1
    assert np.abs(sim.joints.velocity).max() < 1e-3


def test_a_step_is_one_control_period(sim):
    assert sim.period_s == 0.01
    sim.step()
    assert sim.time_s == 0.01


@pytest.mark.parametrize(("seconds", "ticks"), [(0.0, 0), (0.3, 30), (0.011, 2), (0.0001, 1)])
def test_run_advances_to_the_tick_at_or_after_its_end(sim, seconds, ticks):
    sim.run(seconds)
    assert sim.time_s == pytest.approx(ticks * 0.01)


@pytest.mark.parametrize("seconds", [-1.0, math.nan, math.inf])
def test_run_refuses_what_is_no_time(sim, seconds):
    with pytest.raises(CallError, match="cannot run for"):
        sim.run(seconds)


def test_run_until_tells_whether_the_condition_held_in_time(sim):
    assert sim.run_until(lambda: sim.time_s >= 0.05, timeout_s=1.0)
    assert sim.time_s == pytest.approx(0.05)
    assert not sim.run_until(lambda: False, timeout_s=0.1)
    assert sim.time_s == pytest.approx(0.15)


def test_joints_are_a_mapping(sim):
    assert list(sim.joints) == ["j0", "j1", "j2", "j3"]
    assert len(sim.joints) == 4
    with pytest.raises(UnknownNameError, match="no joint 'j9'; the robot has j0, j1, j2, j3"):
        sim.joints["j9"]


def test_arrays_of_joints_are_copies(sim):
    position = sim.joints.position
    position[:] = 9.0
    assert sim.joints.position == pytest.approx(0.0, abs=1e-6)


def test_an_unknown_controller_is_named_with_those_that_are_loaded(sim):
    with pytest.raises(
        UnknownNameError,
        match="no controller 'x'; loaded: joint_state_broadcaster, position_controller",
    ):
        sim["x"]


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ([1.0], r"command size \(1\) does not match number of interfaces \(4\)"),
        ([0.0, 0.0, math.nan, 0.0], "a command with a NaN or an infinity was dropped"),
    ],
)
def test_a_bad_command_is_refused_at_once(sim, values, message):
    with pytest.raises(ControllerError, match=message):
        sim["position_controller"].command(values)


def test_a_broadcaster_takes_no_commands(sim):
    with pytest.raises(
        ControllerError, match="controller 'joint_state_broadcaster' takes no commands"
    ):
        sim["joint_state_broadcaster"].command([1.0])


def test_controllers_are_switched_and_started_later(sim):
    with pytest.raises(ArmControlError):
        sim.controllers.start("joint_trajectory_controller")
    assert sim["joint_trajectory_controller"].state is LifecycleState.INACTIVE
    sim.controllers.switch(["joint_trajectory_controller"], ["position_controller"])
    assert sim["joint_trajectory_controller"].state is LifecycleState.ACTIVE
    with pytest.raises(CallError, match="'position_controller' is inactive and takes no commands"):
        sim["position_controller"].command([0.0] * 4)


def test_a_closed_simulation_says_so():
    with Simulation("arm", arguments={"camera": "none"}) as sim:
        pass
    sim.close()
    with pytest.raises(CallError, match="the simulation is closed"):
        sim.step()


def test_commands_beyond_a_limit_are_logged_as_the_node_does(sim, caplog):
    sim["position_controller"].command([0.0, 9.0, 0.0, 0.0])
    with caplog.at_level(logging.WARNING, "arm_sim"):
        sim.run(0.1)
    assert [record.message for record in caplog.records] == [
        "joint 'j1': position command 9 rad is beyond its limit of 3.14 rad, which is used instead"
    ]


@pytest.mark.parametrize(
    ("description", "options", "error", "message"),
    [
        ("nowhere.urdf", {}, DescriptionError, "nowhere.urdf"),
        ("arm", {"world": "moon"}, WorldError, "no world 'moon'"),
        ("arm", {"spawn": ["nobody"]}, ArmControlError, "The 'type' param was not defined"),
        ("arm", {"base": "loose"}, ParameterValueError, "base must be one of fixed, free"),
        ("arm", {"seed": 0.5}, ParameterValueError, "seed must be a whole number"),
    ],
)
def test_bad_arguments_get_the_sentences_of_the_node(description, options, error, message):
    with pytest.raises(error, match=message):
        Simulation(description, **options)


def test_an_unknown_controller_type_is_named(tmp_path):
    file = tmp_path / "controllers.yaml"
    file.write_text(
        "controller_manager: {ros__parameters: {update_rate: 50, mine: {type: my/Controller}}}"
    )
    with pytest.raises(RegistryError, match="no controller type 'my/Controller'; known:"):
        Simulation("arm", controllers=file, spawn=["mine"])


def test_it_needs_no_ros_and_no_window_library():
    environment = {name: value for name, value in os.environ.items() if name != "MUJOCO_GL"}
    command = [sys.executable, "-c", WITHOUT_ROS]
    done = subprocess.run(
        command, capture_output=True, text=True, check=True, timeout=120, env=environment
    )
    assert done.stdout == "[] None\n"


THREADS_OF_NUMPY = """
import os, sys
name = "OPENBLAS_THREAD_TIMEOUT"
class Watch:
    def find_spec(imported, *_):
        if imported == "numpy":
            print(os.environ.get(name), end=" ")
sys.meta_path.insert(0, Watch)
from arm_sim import Simulation
print(os.environ.get(name))
"""


@pytest.mark.parametrize(("own", "said"), [(None, "20 None\n"), ("8", "8 8\n")])
def test_threads_of_numpy_soon_sleep_unless_the_user_says_otherwise(own, said):
    environment = {name: value for name, value in os.environ.items() if "OPENBLAS" not in name}
    if own is not None:
        environment["OPENBLAS_THREAD_TIMEOUT"] = own
    command = [sys.executable, "-c", THREADS_OF_NUMPY]
    done = subprocess.run(
        command, capture_output=True, text=True, check=True, timeout=120, env=environment
    )
    assert done.stdout == said


def failing(time_s: float, period_s: float) -> None:
    raise ZeroDivisionError("by nothing")


def test_a_controller_that_raises_is_stopped_and_logged_as_in_the_node(sim, caplog):
    sim["position_controller"].core.update = failing
    sim.step()
    assert sim["position_controller"].state is LifecycleState.INACTIVE
    assert "controller 'position_controller' raised in its update" in caplog.text
    sim.run(0.1)


def test_it_raises_where_the_parameters_ask_for_that(tmp_path):
    file = tmp_path / "controllers.yaml"
    file.write_text(
        "controller_manager: {ros__parameters: {handle_exceptions: false, position_controller: "
        "{type: position_controllers/JointGroupPositionController}}}\n"
        "position_controller: {ros__parameters: {joints: [j0]}}\n"
    )
    with Simulation("arm", arguments={"camera": "none"}, controllers=file) as sim:
        sim["position_controller"].core.update = failing
        with pytest.raises(UnhandledFailureError, match="'position_controller' raised"):
            sim.step()


def test_any_urdf_gets_a_controller(tmp_path):
    file = tmp_path / "pendulum.urdf"
    file.write_text(pendulum())
    with Simulation(file) as sim:
        sim["position_controller"].command([0.5])
        sim.run(1.0)
        assert sim.joints["hinge"].position == pytest.approx(0.5, abs=1e-3)
