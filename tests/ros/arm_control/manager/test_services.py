"""The controller manager's services, as clients of ros2_control call them."""

from typing import Any

import pytest
from builtin_interfaces.msg import Duration
from lifecycle_msgs.msg import State

POSITION = "position_controllers/JointGroupPositionController"
BROADCASTER = "joint_state_broadcaster/JointStateBroadcaster"
INTERFACES = "controller_interface::"
JOINTS = ("j0", "j1", "j2", "j3")
COMMANDS = [f"{joint}/position" for joint in JOINTS]

STRICT = 2


def test_the_services_of_a_real_one_are_there(control, client, services):
    control.list()
    expected = {
        f"/controller_manager/{name}": [f"controller_manager_msgs/srv/{type_}"]
        for name, type_ in services.items()
    }

    def all_offered() -> dict[str, list[str]] | None:
        # DDS tells which node a service belongs to later than that the service exists.
        if "controller_manager" not in client.node.get_node_names():
            return None
        offered = client.node.get_service_names_and_types_by_node("controller_manager", "/")
        return dict(offered) if expected.keys() <= dict(offered).keys() else None

    offered = client.wait_until(all_offered, f"the services {sorted(expected)}")
    assert {name: offered[name] for name in expected} == expected


def test_controller_types_are_listed_with_their_base_class(control):
    answer = control.call("list_controller_types")
    base_classes = dict(zip(answer.types, answer.base_classes, strict=True))
    assert base_classes[POSITION] == base_classes[BROADCASTER] == f"{INTERFACES}ControllerInterface"
    assert base_classes["pid_controller/PidController"] == (
        f"{INTERFACES}ChainableControllerInterface"
    )


def test_an_unloaded_controller_leaves_nothing_behind(control, manager):
    for _ in range(3):
        control.start("joint_state_broadcaster")
        control.unload_all()
    # rcl says so where a node of the same name is still there.
    assert "already registered" not in manager.output


def test_list_controllers_says_what_is_claimed_and_required(control):
    control.start("joint_state_broadcaster", "position_controller")
    position, broadcaster = control.list()
    assert (position.name, position.type, position.state) == (
        "position_controller",
        POSITION,
        "active",
    )
    assert (position.update_rate, position.is_async, position.is_chainable) == (100, False, False)
    assert position.claimed_interfaces == position.required_command_interfaces == COMMANDS
    assert position.required_state_interfaces == []
    assert broadcaster.name == "joint_state_broadcaster"
    assert broadcaster.claimed_interfaces == []
    assert set(broadcaster.required_state_interfaces) == {
        f"{joint}/{interface}"
        for joint in JOINTS
        for interface in ("position", "velocity", "effort")
    }


def test_what_cannot_be_loaded_leaves_its_reason_in_the_log(control, manager):
    assert not control.load("nothere")
    manager.wait_for_line("The 'type' param was not defined for 'nothere'. It is defined for ")


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("two words", "controller 'two words' cannot be created: InvalidNodeNameException: "),
        ("controller_manager", "a controller cannot have the controller manager's name 'c"),
    ],
)
def test_a_name_that_its_node_cannot_have_is_refused(control, manager, set_parameter, name, reason):
    assert set_parameter("/controller_manager", f"{name}.type", POSITION).successful
    assert not control.load(name)
    manager.wait_for_line(reason)
    assert "Traceback" not in manager.output


def test_a_switch_is_done_as_soon_as_possible_or_not(control):
    control.load("position_controller")
    control.configure("position_controller")
    for activate_asap in (True, False):
        for lists in ("activate_controllers", "deactivate_controllers"):
            answer = control.call(
                "switch_controller",
                strictness=STRICT,
                activate_asap=activate_asap,
                **{lists: ["position_controller"]},
            )
            assert answer.ok, answer.message


@pytest.mark.parametrize("action", ["configure", "unload"])
def test_an_unknown_name_is_refused(control, action):
    assert not getattr(control, action)("nothere")


def test_an_inactive_controller_reads_its_parameters_again(control, set_parameter):
    control.load("position_controller")
    control.configure("position_controller")
    set_parameter("/position_controller", "joints", ["j1"])
    assert control.configure("position_controller")
    (controller,) = control.list()
    assert controller.required_command_interfaces == ["j1/position"]


def test_parameters_that_make_no_sense_fail_the_configuration(control, manager, set_parameter):
    control.load("position_controller")
    set_parameter("/position_controller", "joints", [])
    assert not control.configure("position_controller")
    manager.wait_for_line("'joints' parameter was empty")
    assert control.states() == {"position_controller": "unconfigured"}


def test_the_type_may_be_set_while_it_runs(control, set_parameter):
    set_parameter("/controller_manager", "late.type", BROADCASTER)
    assert control.load("late")
    assert control.states() == {"late": "unconfigured"}


def test_an_unknown_name_is_left_out_by_default(control):
    answer = control.switch(["nothere"], [], strictness=0)
    assert not answer.ok
    assert answer.message == (
        "Could not activate controller with name 'nothere' "
        "because no controller with this name exists\n"
    )


def test_an_unknown_strictness_is_refused(control):
    answer = control.switch([], [], 9)
    assert (answer.ok, answer.message) == (False, "unknown strictness 9; it is 1, 2, 3 or 4")


def test_hardware_interfaces(control):
    control.start("second_controller")
    answer = control.call("list_hardware_interfaces")
    claimed = {i.name: i.is_claimed for i in answer.command_interfaces}
    assert [name for name, is_claimed in claimed.items() if is_claimed] == ["j3/position"]
    names = [i.name for i in answer.state_interfaces]
    assert names == sorted(names)
    assert len(names) == 12
    interfaces = (*answer.command_interfaces, *answer.state_interfaces)
    assert all(i.is_available and i.data_type == "double" for i in interfaces)


def test_hardware_components(control):
    (component,) = control.call("list_hardware_components").component
    assert (component.name, component.type, component.rw_rate) == (
        "HardwareInterface",
        "system",
        100,
    )
    assert component.plugin_name == "mock_components/GenericSystem"
    assert (component.state.id, component.state.label) == (3, "active")
    assert len(component.command_interfaces) == 8


def test_hardware_can_be_deactivated_and_activated_by_id_or_label(control):
    def set_state(name: str, **state: Any) -> Any:
        return control.call("set_hardware_component_state", name=name, target_state=State(**state))

    control.start("position_controller")
    inactive = set_state("HardwareInterface", id=2)
    assert (inactive.ok, inactive.state.label) == (True, "inactive")
    assert control.states() == {"position_controller": "active"}
    active = set_state("HardwareInterface", label="active")
    assert (active.ok, active.state.id) == (True, 3)
    assert not set_state("nothere", id=3).ok
    assert not set_state("HardwareInterface", label="asleep").ok


def test_everything_works_while_paused(control, manager):
    manager.tell("pause")
    try:
        control.start("joint_state_broadcaster", "position_controller")
        assert control.switch([], ["position_controller"]).ok
        assert control.unload("position_controller")
        assert control.states() == {"joint_state_broadcaster": "active"}
    finally:
        manager.tell("resume")


def test_a_loop_that_is_stuck_lets_a_switch_time_out_and_lists_are_answered(control, manager):
    control.load("position_controller")
    control.configure("position_controller")
    manager.tell("block")
    try:
        answer = control.call(
            "switch_controller",
            activate_controllers=["position_controller"],
            strictness=STRICT,
            timeout=Duration(nanosec=200_000_000),
        )
        states = control.states()
        (component,) = control.call("list_hardware_components").component
    finally:
        manager.tell("unblock")
    assert (answer.ok, answer.message) == (False, "Switch controller timed out after 0.2 seconds!")
    assert states == {"position_controller": "inactive"}
    assert component.state.label == "active"
    assert control.states() == {"position_controller": "inactive"}


def test_lists_are_answered_while_a_change_waits_for_a_loop_that_is_stuck(control, manager):
    control.load("position_controller")
    manager.tell("block")
    try:
        configured = control.ask("configure_controller", name="position_controller")
        states = control.states()
        (component,) = control.call("list_hardware_components").component
        waited = not configured.done()
    finally:
        manager.tell("unblock")
    assert waited
    assert states == {"position_controller": "unconfigured"}
    assert component.state.label == "active"
    control.wait_for_states(position_controller="inactive")


def test_reload_unloads_everything_active_controllers_only_by_force(control):
    def reload(force: bool) -> bool:
        return control.call("reload_controller_libraries", force_kill=force).ok

    control.start("position_controller")
    control.load("second_controller")
    assert not reload(False)
    assert control.states()["position_controller"] == "active"
    assert reload(True)
    assert control.states() == {}
