"""The unspawner as a program."""

import signal

import pytest


def test_it_deactivates_and_unloads(control, unspawn):
    control.start("joint_state_broadcaster", "position_controller")
    output = unspawn("position_controller").succeed()
    assert "Deactivated controllers: position_controller" in output
    assert "Unloaded controller position_controller" in output
    assert control.states() == {"joint_state_broadcaster": "active"}


def test_those_that_are_not_active_need_no_switch(control, unspawn):
    assert control.load("position_controller")
    assert control.load("second_controller")
    unspawn("position_controller", "second_controller").succeed()
    assert control.states() == {}


@pytest.mark.parametrize("other", ["nothere", "second_controller"])
def test_beside_one_that_is_not_active_an_active_one_stays(control, unspawn, other):
    control.start("position_controller")
    assert control.load("second_controller")
    output = unspawn(other, "position_controller", "-c", "/controller_manager").fail()
    assert f"Nothing is unloaded: position_controller is active, but {other} is not" in output
    assert control.states() == {
        "position_controller": "active",
        "second_controller": "unconfigured",
    }


def test_one_that_is_not_there_is_a_failure(control, unspawn):
    output = unspawn("nothere").fail()
    assert "Failed to unload controller nothere" in output


def test_the_manager_is_looked_for_in_the_own_namespace_and_a_signal_ends_the_wait(unspawn):
    unspawner = unspawn("a", "--ros-args", "-r", "__ns:=/far")
    unspawner.wait_for_line("waiting for service /far/controller_manager/list_controllers")
    assert unspawner.stop(signal.SIGINT) == 0
    assert "Traceback" not in unspawner.output


def test_a_manager_that_no_node_can_be_is_a_sentence(unspawn):
    output = unspawn("a", "-c", "bad name!").fail()
    assert "no controller manager can be named '/bad name!': Invalid service name" in output
