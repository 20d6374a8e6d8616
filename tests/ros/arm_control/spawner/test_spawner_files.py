"""The spawner's parameter files and ROS arguments."""

from typing import Any

import pytest

POSITION = "position_controllers/JointGroupPositionController"
BROADCASTER = "joint_state_broadcaster/JointStateBroadcaster"


def node(**parameters: Any) -> dict[str, Any]:
    return {"ros__parameters": parameters}


def test_a_file_brings_type_and_parameters(control, spawn, manager, file, get_parameter):
    path = file({"fresh": node(type=POSITION, joints=["j2"], fallback_controllers=["a", "b"])})
    spawn("fresh", "--inactive", "-p", path).succeed()
    (controller,) = control.list()
    assert controller.type == POSITION
    assert controller.required_command_interfaces == ["j2/position"]
    assert get_parameter("/controller_manager", "fresh.fallback_controllers") == ["a", "b"]
    assert get_parameter("/controller_manager", "fresh.params_file") == [path]
    # All of it is known: what is for the spawner is no strange parameter of the controller.
    assert "is not known to" not in manager.output


def test_a_wildcard_serves_many_controllers_beside_their_own_entries(control, spawn, file):
    names = [f"jsb_{number}" for number in range(12)]
    path = file(
        {"/**": node(type=BROADCASTER, use_local_topics=True)}
        | {name: node(joints=["j1"], interfaces=["position"]) for name in names}
    )
    spawn(*names, "--activate-as-group", "-p", path).succeed()
    assert control.states() == dict.fromkeys(names, "active")
    states = {tuple(controller.required_state_interfaces) for controller in control.list()}
    assert states == {("j1/position",)}


def test_every_key_that_names_a_controller_serves(control, spawn, file):
    keys = {"/a": "j0", "/**/b": "j1", "c": "j2"}
    entries = {key: node(type=POSITION, joints=[joint]) for key, joint in keys.items()}
    nested = {"/**": {"d": node(type=POSITION, joints=["j3"])}}
    spawn("a", "b", "c", "d", "-p", file(entries | nested)).succeed()
    claimed = {c.name: c.claimed_interfaces for c in control.list()}
    assert claimed == {name: [f"j{i}/position"] for i, name in enumerate("abcd")}


def test_a_file_may_be_known_to_the_manager_alone(control, spawn, file, set_parameter):
    path = file({"known": node(joints=["j1"])})
    assert set_parameter("/controller_manager", "known.type", POSITION).successful
    assert set_parameter("/controller_manager", "known.params_file", path).successful
    spawn("known").succeed()
    assert control.list()[0].claimed_interfaces == ["j1/position"]


@pytest.mark.parametrize("order", [("j1", "j2"), ("j2", "j1")])
def test_of_several_files_the_last_wins(control, spawn, file, get_parameter, order):
    files = [file({"fresh": node(type=POSITION, joints=[joint])}, joint) for joint in order]
    other = file({"another": node(type=POSITION)}, "other")
    spawn("fresh", "--inactive", "-p", files[0], "-p", other, "-p", files[1]).succeed()
    assert control.list()[0].required_command_interfaces == [f"{order[1]}/position"]
    # A file that does not speak of the controller is not handed on.
    assert get_parameter("/controller_manager", "fresh.params_file") == files


def test_a_file_of_the_spawners_own_node_serves_the_controller(control, spawn, file):
    own = file({"fresh": node(type=POSITION, joints=["j0"])}, "own")
    ros = file({"fresh": node(joints=["j3"])}, "ros")
    spawn("fresh", "--inactive", "-p", own, "--ros-args", "--params-file", ros).succeed()
    assert control.list()[0].required_command_interfaces == ["j3/position"]


def test_a_missing_file_ends_with_a_sentence(control, spawn):
    output = spawn("position_controller", "-p", "/no/such/file.yaml").fail()
    assert "cannot read parameter file '/no/such/file.yaml'" in output


def test_ros_arguments_reach_the_controllers_node(control, spawn, client, get_parameter):
    spawn(
        "position_controller",
        "--controller-ros-args",
        "-r ~/commands:=/elsewhere",
        "--controller-ros-args",
        "-p thread_priority:=-7",
    ).succeed()
    client.wait_until(
        lambda: client.node.get_subscriptions_info_by_topic("/elsewhere"), "the remapped topic"
    )
    assert get_parameter("/position_controller", "thread_priority") == -7


def test_controllers_may_have_options_of_their_own(control, spawn, file):
    first = file({"first": node(type=POSITION, joints=["j0"])}, "first")
    second = file({"second": node(type=POSITION, joints=["j1"])}, "second")
    spawner = spawn(
        *("--controller", "first", "--inactive", "-p", first),
        *("--controller", "second", "-p", second, "-c", "/controller_manager", "-u"),
    )
    spawner.wait_for_line("Waiting until interrupt to unload controllers")
    assert control.states() == {"first": "inactive", "second": "active"}
    assert spawner.stop() == 0
    # What was left inactive on purpose outlives the spawner.
    assert control.states() == {"first": "inactive"}


def test_in_a_namespace_a_key_must_name_it(spawn, run_manager, control_of, file):
    run_manager(parameters={}, ros_arguments=("-r", "__ns:=/near"))
    namespace = ("--ros-args", "-r", "__ns:=/near")
    bare = file({"fresh": node(type=POSITION, joints=["j1"])}, "bare")
    output = spawn("fresh", "-p", bare, *namespace).fail()
    assert "names 'fresh' without its namespace: write '/near/fresh'" in output
    full = file({"/near/fresh": node(type=POSITION, joints=["j1"])}, "full")
    spawn("fresh", "-p", full, *namespace).succeed()
    assert control_of("/near").list()[0].claimed_interfaces == ["j1/position"]
