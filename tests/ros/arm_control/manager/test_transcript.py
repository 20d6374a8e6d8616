"""The answers of a real Jazzy controller manager, compared with ours in the same order.

Read off a C++ ros2_control_node by its command-line client; each row is one call and its answer.
"""

import pytest

JTC = "joint_trajectory_controller"
POSITION = "position_controller"
JOINTS = ("j0", "j1", "j2", "j3")
BEST_EFFORT, STRICT = 1, 2

UNKNOWN = (
    "Could not activate controller with name 'nothere' because no controller with this name exists"
)
CLAIMED = (
    f"Unable to activate controller '{JTC}' since the command interface 'j0/position' is "
    "currently claimed by another controller."
)
SWITCHED = "Successfully switched controllers!"
NOTHING = "After checking the controllers, no controllers need to be activated or deactivated."
BACK = f"{SWITCHED}\nDeactivated controllers: [ {JTC} ]\nActivated controllers: [ {POSITION} ]"


@pytest.fixture(scope="module")
def manager(run_manager):
    """Return a manager that knows the trajectory controller, too."""
    types = {
        "joint_state_broadcaster": "joint_state_broadcaster/JointStateBroadcaster",
        POSITION: "position_controllers/JointGroupPositionController",
        JTC: f"{JTC}/JointTrajectoryController",
    }
    interfaces = {"command_interfaces": ["position"], "state_interfaces": ["position", "velocity"]}
    return run_manager(
        parameters={
            "controller_manager": {
                "ros__parameters": {f"{name}.type": type_ for name, type_ in types.items()}
            },
            POSITION: {"ros__parameters": {"joints": list(JOINTS)}},
            JTC: {"ros__parameters": {"joints": list(JOINTS), **interfaces}},
        }
    )


def test_the_session_goes_as_with_a_real_one(control):
    control.start("joint_state_broadcaster", POSITION)
    assert control.load(JTC)
    assert control.configure(JTC)
    assert not control.load("nothere")
    for activate, deactivate, strictness, ok, message in (
        (["nothere"], [], BEST_EFFORT, False, f"{UNKNOWN}\n"),
        (["nothere"], [], STRICT, False, UNKNOWN),
        ([JTC], [], STRICT, False, CLAIMED),
        ([JTC], [POSITION], STRICT, True, SWITCHED),
        ([JTC], [], BEST_EFFORT, True, NOTHING),
    ):
        answer = control.switch(activate, deactivate, strictness)
        assert (answer.ok, answer.message) == (ok, message)
    assert not control.unload(JTC)
    answer = control.switch([POSITION], [JTC], BEST_EFFORT)
    assert (answer.ok, answer.message) == (True, BACK)
    assert control.unload(JTC)
    # Newest first.
    assert [(c.name, c.state) for c in control.list()] == [
        (POSITION, "active"),
        ("joint_state_broadcaster", "active"),
    ]
