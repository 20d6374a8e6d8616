"""The controller manager as clients of ros2_control see it."""

import itertools
from collections.abc import Callable
from typing import Any

import pytest

pytestmark = pytest.mark.ros

POSITION = "position_controllers/JointGroupPositionController"
BROADCASTER = "joint_state_broadcaster/JointStateBroadcaster"
JOINTS = ("j0", "j1", "j2", "j3")
COMMANDS = [f"{joint}/position" for joint in JOINTS]

BEST_EFFORT, STRICT = 1, 2


# Services


def test_the_services_of_a_real_one_are_there(control: Any, client: Any) -> None:
    control.list()
    services = dict(client.node.get_service_names_and_types_by_node("controller_manager", "/"))
    expected = {
        "cleanup_controller": "CleanupController",
        "configure_controller": "ConfigureController",
        "list_controller_types": "ListControllerTypes",
        "list_controllers": "ListControllers",
        "list_hardware_components": "ListHardwareComponents",
        "list_hardware_interfaces": "ListHardwareInterfaces",
        "load_controller": "LoadController",
        "reload_controller_libraries": "ReloadControllerLibraries",
        "set_hardware_component_state": "SetHardwareComponentState",
        "switch_controller": "SwitchController",
        "unload_controller": "UnloadController",
    }
    for name, type_ in expected.items():
        assert services[f"/controller_manager/{name}"] == [f"controller_manager_msgs/srv/{type_}"]


def test_controller_types_are_listed_with_their_base_class(control: Any) -> None:
    answer = control.call("ListControllerTypes", "list_controller_types")
    assert {POSITION, BROADCASTER} <= set(answer.types)
    assert set(answer.base_classes) == {"controller_interface::ControllerInterface"}
    assert len(answer.base_classes) == len(answer.types)


def test_a_controller_from_load_to_unload(control: Any) -> None:
    assert control.load("position_controller")
    assert control.states() == {"position_controller": "unconfigured"}
    assert control.configure("position_controller")
    assert control.states() == {"position_controller": "inactive"}
    answer = control.switch(["position_controller"])
    assert (answer.ok, answer.message) == (True, "Successfully switched controllers!")
    assert control.states() == {"position_controller": "active"}
    assert not control.unload("position_controller")
    assert control.switch([], ["position_controller"]).ok
    assert control.unload("position_controller")
    assert control.states() == {}


def test_list_controllers_says_what_is_claimed_and_required(control: Any) -> None:
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


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("nothere", "The 'type' param was not defined for 'nothere'."),
        (
            "strange_controller",
            "no controller type 'strange_controllers/StrangeController'; there is effort_contr",
        ),
    ],
)
def test_what_cannot_be_loaded_leaves_its_reason_in_the_log(
    control: Any, manager: Any, name: str, reason: str
) -> None:
    assert not control.load(name)
    manager.wait_for_line(reason)


def test_a_name_is_loaded_only_once(control: Any, manager: Any) -> None:
    control.load("position_controller")
    assert not control.load("position_controller")
    manager.wait_for_line(
        "A controller named 'position_controller' was already loaded inside the controller manager"
    )


@pytest.mark.parametrize("action", ["configure", "unload"])
def test_an_unknown_name_is_refused(control: Any, action: str) -> None:
    assert not getattr(control, action)("nothere")


def test_an_active_controller_is_not_configured(control: Any, manager: Any) -> None:
    control.start("position_controller")
    assert not control.configure("position_controller")
    manager.wait_for_line("can not be configured from 'active' state")


def test_an_inactive_controller_reads_its_parameters_anew(control: Any, set_parameter: Any) -> None:
    control.load("position_controller")
    control.configure("position_controller")
    set_parameter("/position_controller", "joints", ["j1"])
    assert control.configure("position_controller")
    (controller,) = control.list()
    assert controller.required_command_interfaces == ["j1/position"]


def test_parameters_that_make_no_sense_fail_the_configuration(
    control: Any, manager: Any, set_parameter: Any
) -> None:
    control.load("position_controller")
    set_parameter("/position_controller", "joints", [])
    assert not control.configure("position_controller")
    manager.wait_for_line("'joints' parameter was empty")
    assert control.states() == {"position_controller": "unconfigured"}


def test_the_type_may_be_set_while_it_runs(control: Any, set_parameter: Any) -> None:
    set_parameter("/controller_manager", "late.type", BROADCASTER)
    assert control.load("late")
    assert control.states() == {"late": "unconfigured"}


@pytest.mark.parametrize(
    ("strictness", "end"), [(STRICT, ""), (BEST_EFFORT, "\n"), (0, "\n")], ids=str
)
def test_switching_an_unknown_name(control: Any, strictness: int, end: str) -> None:
    answer = control.switch(["nothere"], [], strictness)
    assert not answer.ok
    assert answer.message == (
        "Could not activate controller with name 'nothere' "
        f"because no controller with this name exists{end}"
    )


def test_an_unknown_strictness_is_refused(control: Any) -> None:
    answer = control.switch([], [], 9)
    assert (answer.ok, answer.message) == (False, "unknown strictness 9; it is 1, 2, 3 or 4")


def test_switching_to_a_controller_whose_interface_is_taken(control: Any) -> None:
    control.start("position_controller")
    control.load("second_controller")
    control.configure("second_controller")
    answer = control.switch(["second_controller"])
    assert answer.message == (
        "Unable to activate controller 'second_controller' since the command interface "
        "'j3/position' is currently claimed by another controller."
    )
    answer = control.switch(["second_controller"], ["position_controller"], BEST_EFFORT)
    assert answer.message == (
        "Successfully switched controllers!\n"
        "Deactivated controllers: [ position_controller ]\n"
        "Activated controllers: [ second_controller ]"
    )


def test_hardware_interfaces(control: Any) -> None:
    control.start("second_controller")
    answer = control.call("ListHardwareInterfaces", "list_hardware_interfaces")
    claimed = {i.name: i.is_claimed for i in answer.command_interfaces}
    assert [name for name, is_claimed in claimed.items() if is_claimed] == ["j3/position"]
    names = [i.name for i in answer.state_interfaces]
    assert names == sorted(names)
    assert len(names) == 12
    interfaces = (*answer.command_interfaces, *answer.state_interfaces)
    assert all(i.is_available and i.data_type == "double" for i in interfaces)


def test_hardware_components(control: Any) -> None:
    (component,) = control.call("ListHardwareComponents", "list_hardware_components").component
    assert (component.name, component.type, component.rw_rate) == (
        "HardwareInterface",
        "system",
        100,
    )
    assert component.plugin_name == "mock_components/GenericSystem"
    assert (component.state.id, component.state.label) == (3, "active")
    assert len(component.command_interfaces) == 8


def test_hardware_can_be_deactivated_and_activated_by_id_or_label(control: Any) -> None:
    from lifecycle_msgs.msg import State

    def set_state(name: str, **state: Any) -> Any:
        return control.call(
            "SetHardwareComponentState",
            "set_hardware_component_state",
            name=name,
            target_state=State(**state),
        )

    control.start("position_controller")
    inactive = set_state("HardwareInterface", id=2)
    assert (inactive.ok, inactive.state.label) == (True, "inactive")
    assert control.states() == {"position_controller": "active"}
    active = set_state("HardwareInterface", label="active")
    assert (active.ok, active.state.id) == (True, 3)
    assert not set_state("nothere", id=3).ok
    assert not set_state("HardwareInterface", label="asleep").ok


def test_it_all_works_while_time_stands_still(control: Any, manager: Any) -> None:
    manager.tell("pause")
    try:
        control.start("joint_state_broadcaster", "position_controller")
        assert control.switch([], ["position_controller"]).ok
        assert control.unload("position_controller")
        assert control.states() == {"joint_state_broadcaster": "active"}
    finally:
        manager.tell("resume")


def test_a_loop_that_is_stuck_lets_a_switch_time_out(control: Any, manager: Any) -> None:
    from builtin_interfaces.msg import Duration

    control.load("position_controller")
    control.configure("position_controller")
    manager.tell("block")
    try:
        answer = control.call(
            "SwitchController",
            "switch_controller",
            activate_controllers=["position_controller"],
            strictness=STRICT,
            timeout=Duration(nanosec=200_000_000),
        )
    finally:
        manager.tell("unblock")
    assert (answer.ok, answer.message) == (
        False,
        "Switch controller timed out after 0.200000 seconds!",
    )
    assert control.states() == {"position_controller": "inactive"}


def test_reload_unloads_everything_active_controllers_only_by_force(control: Any) -> None:
    def reload(force: bool) -> bool:
        return control.call(
            "ReloadControllerLibraries", "reload_controller_libraries", force_kill=force
        ).ok

    control.start("position_controller")
    control.load("second_controller")
    assert not reload(False)
    assert control.states()["position_controller"] == "active"
    assert reload(True)
    assert control.states() == {}


# The graph


def end_points(client: Any, topic: str, kind: str) -> list[Any]:
    return getattr(client.node, f"get_{kind}_info_by_topic")(topic)


@pytest.mark.parametrize(
    ("topic", "kind", "node", "type_", "reliability", "durability"),
    [
        row.split()
        for row in (
            "/joint_states publishers joint_state_broadcaster"
            " sensor_msgs/msg/JointState RELIABLE TRANSIENT_LOCAL",
            "/dynamic_joint_states publishers joint_state_broadcaster"
            " control_msgs/msg/DynamicJointState RELIABLE TRANSIENT_LOCAL",
            "/joint_state_broadcaster/transition_event publishers joint_state_broadcaster"
            " lifecycle_msgs/msg/TransitionEvent RELIABLE VOLATILE",
            "/position_controller/commands subscriptions position_controller"
            " std_msgs/msg/Float64MultiArray BEST_EFFORT VOLATILE",
            "/position_controller/transition_event publishers position_controller"
            " lifecycle_msgs/msg/TransitionEvent RELIABLE VOLATILE",
            "/controller_manager/activity publishers controller_manager"
            " controller_manager_msgs/msg/ControllerManagerActivity RELIABLE TRANSIENT_LOCAL",
            "/robot_description subscriptions controller_manager"
            " std_msgs/msg/String RELIABLE TRANSIENT_LOCAL",
        )
    ],
    ids=lambda value: value if value.startswith("/") else "",
)
def test_end_points_are_those_of_a_real_one(
    control: Any,
    client: Any,
    topic: str,
    kind: str,
    node: str,
    type_: str,
    reliability: str,
    durability: str,
) -> None:
    control.start("joint_state_broadcaster", "position_controller")
    client.wait_until(lambda: end_points(client, topic, kind), f"{kind} of {topic}")
    (end_point,) = end_points(client, topic, kind)
    assert (end_point.node_name, end_point.topic_type) == (node, type_)
    assert end_point.qos_profile.reliability.name == reliability
    assert end_point.qos_profile.durability.name == durability


def test_there_is_a_node_for_each_controller_and_component(control: Any, client: Any) -> None:
    control.start("joint_state_broadcaster")
    expected = {"controller_manager", "joint_state_broadcaster", "hardwareinterface"}
    client.wait_until(lambda: expected <= set(client.node.get_node_names()), f"nodes {expected}")


def test_controllers_have_no_life_cycle_services(control: Any, client: Any) -> None:
    control.start("joint_state_broadcaster")
    client.wait_until(lambda: "joint_state_broadcaster" in client.node.get_node_names(), "the node")
    services = client.node.get_service_names_and_types_by_node("joint_state_broadcaster", "/")
    assert not [name for name, types in services if "lifecycle_msgs" in types[0]]


def test_unload_takes_the_node_away(control: Any, client: Any) -> None:
    control.load("position_controller")
    client.wait_until(lambda: "position_controller" in client.node.get_node_names(), "the node")
    control.unload("position_controller")
    client.wait_until(
        lambda: "position_controller" not in client.node.get_node_names(), "the node's end"
    )


@pytest.fixture
def latched() -> Any:
    """Return the profile of a subscriber that wants the last message, too."""
    from rclpy.qos import DurabilityPolicy, QoSProfile

    return QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def test_a_late_listener_learns_the_activity(control: Any, client: Any, latched: Any) -> None:
    from controller_manager_msgs.msg import ControllerManagerActivity

    control.start("position_controller")
    activity = client.subscribe(ControllerManagerActivity, "/controller_manager/activity", latched)
    message = activity.wait_for(1)[0]
    assert [(c.name, c.state.label) for c in message.controllers] == [
        ("position_controller", "active")
    ]
    assert [(c.name, c.state.id) for c in message.hardware_components] == [("HardwareInterface", 3)]
    control.switch([], ["position_controller"])
    message = activity.wait_for(2)[-1]
    assert message.controllers[0].state.label == "inactive"


def test_transitions_are_published(control: Any, client: Any) -> None:
    from lifecycle_msgs.msg import TransitionEvent

    control.load("position_controller")
    events = client.subscribe(TransitionEvent, "/position_controller/transition_event")
    client.wait_until(
        lambda: end_points(client, "/position_controller/transition_event", "publishers"),
        "the publisher",
    )
    # Which of the first events a subscriber sees depends on when it is matched: let it see one.
    while not events.messages:
        assert control.configure("position_controller")
    events.clear()
    control.switch(["position_controller"])
    seen = [(e.start_state.label, e.goal_state.label) for e in events.wait_for(2)[-2:]]
    assert seen == [("inactive", "activating"), ("activating", "active")]


# Joint states


def test_joint_states_are_complete_and_in_order(control: Any, client: Any) -> None:
    from control_msgs.msg import DynamicJointState
    from sensor_msgs.msg import JointState

    control.start("joint_state_broadcaster")
    messages = client.subscribe(JointState, "/joint_states").wait_for(3)
    for message in messages:
        assert message.name == list(JOINTS)
        assert message.header.frame_id == "base_link"
        assert len(message.position) == len(message.velocity) == len(message.effort) == 4
    dynamic = client.subscribe(DynamicJointState, "/dynamic_joint_states").wait_for(1)[0]
    assert dynamic.header.frame_id == "base_link"
    assert dynamic.joint_names == list(JOINTS)
    assert [list(v.interface_names) for v in dynamic.interface_values] == [
        ["position", "velocity", "effort"]
    ] * 4


def test_stamps_are_one_period_apart(control: Any, client: Any) -> None:
    from sensor_msgs.msg import JointState

    control.start("joint_state_broadcaster")
    messages = client.subscribe(JointState, "/joint_states").wait_for(20)
    stamps = [m.header.stamp.sec * 10**9 + m.header.stamp.nanosec for m in messages]
    steps = {b - a for a, b in itertools.pairwise(stamps)}
    assert all(step > 0 and step % 10_000_000 == 0 for step in steps)


def test_a_late_listener_gets_the_last_state_though_time_stands_still(
    control: Any, client: Any, manager: Any, latched: Any
) -> None:
    from sensor_msgs.msg import JointState

    control.start("joint_state_broadcaster")
    client.subscribe(JointState, "/joint_states").wait_for(1)
    manager.tell("pause")
    try:
        late = client.subscribe(JointState, "/joint_states", latched)
        assert late.wait_for(1)[0].name == list(JOINTS)
    finally:
        manager.tell("resume")


def test_topics_can_be_local(control: Any, client: Any, run_manager: Any) -> None:
    from sensor_msgs.msg import JointState

    parameters = {
        "/**/controller_manager": {"ros__parameters": {"jsb.type": BROADCASTER}},
        "/**/jsb": {"ros__parameters": {"use_local_topics": True}},
    }
    run_manager("--start", "jsb", parameters=parameters, ros_arguments=("-r", "__ns:=/left"))
    client.subscribe(JointState, "/left/jsb/joint_states").wait_for(1)


# Parameters


@pytest.fixture
def set_parameter(client: Any) -> Callable[..., Any]:
    """Return a function that sets a parameter of a node and returns the result."""
    from rcl_interfaces.srv import SetParameters
    from rclpy.parameter import Parameter

    def set_(node: str, name: str, value: Any) -> Any:
        kind = Parameter.Type.STRING_ARRAY if value == [] else None
        message = Parameter(name, kind, value).to_parameter_msg()
        request = SetParameters.Request(parameters=[message])
        return client.call(SetParameters, f"{node}/set_parameters", request).results[0]

    return set_


@pytest.fixture
def parameters_of(client: Any) -> Callable[[str], dict[str, Any]]:
    """Return a function that reads all parameters of a node."""
    from rcl_interfaces.srv import GetParameters, ListParameters
    from rclpy.parameter import parameter_value_to_python

    def read(node: str) -> dict[str, Any]:
        names = client.call(
            ListParameters, f"{node}/list_parameters", ListParameters.Request()
        ).result.names
        values = client.call(
            GetParameters, f"{node}/get_parameters", GetParameters.Request(names=names)
        ).values
        return {
            name: parameter_value_to_python(value)
            for name, value in zip(names, values, strict=True)
        }

    return read


def test_the_managers_parameters(control: Any, parameters_of: Any) -> None:
    control.load("position_controller")
    parameters = parameters_of("/controller_manager")
    expected = {
        "update_rate": 100,
        "defaults.switch_controller.strictness": "best_effort",
        "hardware_components_initial_state.unconfigured": [],
        "overruns.print_warnings": True,
        "position_controller.type": POSITION,
        "position_controller.fallback_controllers": [],
        "position_controller.node_options_args": [],
    }
    assert {name: parameters[name] for name in expected} == expected


def test_a_controllers_parameters(control: Any, parameters_of: Any) -> None:
    control.load("position_controller")
    parameters = parameters_of("/position_controller")
    expected = {
        "interface_name": "position",
        "is_async": False,
        "joints": list(JOINTS),
        "thread_priority": -100,
        "update_rate": 100,
    }
    assert {name: parameters[name] for name in expected} == expected


def test_the_broadcasters_parameters_are_read_only(
    control: Any, parameters_of: Any, set_parameter: Any
) -> None:
    control.load("joint_state_broadcaster")
    parameters = parameters_of("/joint_state_broadcaster")
    expected = {
        "extra_joints": [],
        "frame_id": "base_link",
        "interfaces": [],
        "joints": [],
        "map_interface_to_joint_state.effort": "effort",
        "map_interface_to_joint_state.position": "position",
        "map_interface_to_joint_state.velocity": "velocity",
        "publish_dynamic_joint_states": True,
        "use_local_topics": False,
        "use_urdf_to_filter": True,
    }
    assert {name: parameters[name] for name in expected} == expected
    for name, value in (("frame_id", "other"), ("joints", ["j0"])):
        result = set_parameter("/joint_state_broadcaster", name, value)
        assert not result.successful
        assert "read-only" in result.reason


def test_parameters_that_mean_nothing_are_reported(run_manager: Any) -> None:
    program = run_manager(
        "--start",
        "position_controller",
        parameters={
            "/**/controller_manager": {"ros__parameters": {"position_controller.type": POSITION}},
            "/**/position_controller": {
                "ros__parameters": {"joints": ["j0"], "state_publish_rate": 100.0, "open": True}
            },
        },
        ros_arguments=("-r", "__ns:=/reports"),
    )
    line = program.wait_for_line("is not known to")
    assert f"parameter 'open', 'state_publish_rate' is not known to {POSITION}" in line
    assert "it knows interface_name, is_async, joints" in line


def test_an_integer_serves_and_an_empty_list_does_no_harm(run_manager: Any) -> None:
    run_manager(
        "--start",
        "jsb",
        parameters={
            "/**/controller_manager": {
                "ros__parameters": {
                    "jsb": {"type": BROADCASTER, "fallback_controllers": []},
                    "hardware_components_initial_state": {"inactive": []},
                }
            },
            "/**/jsb": {"ros__parameters": {"joints": []}},
        },
        ros_arguments=("-r", "__ns:=/empty"),
    )


@pytest.mark.parametrize(
    ("parameters", "reason"),
    [
        ({"update_rate": 0}, "parameter 'update_rate' of /controller_manager must be positive"),
        ({"update_rate": "fast"}, "parameter 'update_rate' must be of type int, not 'fast'"),
        (
            {"defaults": {"switch_controller": {"strictness": "lax"}}},
            "must be one of best_effort, strict, but is 'lax'",
        ),
    ],
)
def test_parameters_of_the_manager_that_make_no_sense_end_it_with_a_sentence(
    run_manager: Any, parameters: dict[str, Any], reason: str
) -> None:
    program = run_manager(
        parameters={"/**/controller_manager": {"ros__parameters": parameters}},
        ros_arguments=("-r", "__ns:=/refused"),
        wait=False,
    )
    assert program.wait() == 1
    assert reason in program.output
    assert "Traceback" not in program.output


def test_a_controller_that_cannot_be_started_ends_it_with_a_sentence(run_manager: Any) -> None:
    program = run_manager(
        "--start",
        "position_controller",
        parameters={
            "/**/controller_manager": {"ros__parameters": {"position_controller.type": POSITION}},
            "/**/position_controller": {"ros__parameters": {"joints": ["j0", "j9"]}},
        },
        ros_arguments=("-r", "__ns:=/refused"),
        wait=False,
    )
    assert program.wait() == 1
    assert "the command interface 'j9/position' is not available" in program.output
    assert "(available: j0/position, j0/velocity, j1/position" in program.output
    assert "Traceback" not in program.output


# Namespaces, failures, the end


def test_all_of_it_can_live_in_a_namespace(run_manager: Any, control_of: Any, client: Any) -> None:
    from sensor_msgs.msg import JointState

    program = run_manager(
        parameters={
            "/right/controller_manager": {"ros__parameters": {"jsb.type": BROADCASTER}},
            "/right/jsb": {"ros__parameters": {"frame_id": "there"}},
        },
        ros_arguments=("-r", "__ns:=/right", "-r", "__node:=host"),
    )
    control_of("/right").start("jsb")
    message = client.subscribe(JointState, "/right/joint_states").wait_for(1)[0]
    assert message.header.frame_id == "there"
    assert {"jsb", "controller_manager", "hardwareinterface"} <= {
        name
        for name, namespace in client.node.get_node_names_and_namespaces()
        if namespace == "/right"
    }
    assert program.stop() == 0


def test_hardware_that_fails_takes_its_controllers_down(run_manager: Any, control_of: Any) -> None:
    program = run_manager(
        "--start",
        "jsb",
        parameters={"/**/controller_manager": {"ros__parameters": {"jsb.type": BROADCASTER}}},
        ros_arguments=("-r", "__ns:=/failing"),
    )
    control = control_of("/failing")
    program.tell("fail read")
    program.wait_for_line("read cycle resulted in an error: [ HardwareInterface ]")
    control.wait_for_states(jsb="inactive")
    (component,) = control.call("ListHardwareComponents", "list_hardware_components").component
    assert component.state.label == "unconfigured"


@pytest.mark.parametrize("paused", [(), ("--paused",)])
def test_it_ends_with_code_0(run_manager: Any, paused: tuple[str, ...]) -> None:
    program = run_manager(
        *paused,
        "--start",
        "jsb",
        parameters={"/**/controller_manager": {"ros__parameters": {"jsb.type": BROADCASTER}}},
        ros_arguments=("-r", "__ns:=/ending"),
    )
    assert program.stop() == 0
    assert "Traceback" not in program.output
