"""`arm doctor` of a running simulation: the finding of each check for an observation."""

from dataclasses import replace

import pytest

from arm_cli.doctor.diagnosis import Severity
from arm_cli.doctor.observation import (
    ClockReading,
    ControlState,
    GraphObservation,
    LoadedController,
    Mismatch,
    ObservedHardware,
    SetpointTopic,
    StateTopic,
)
from arm_cli.doctor.running import (
    check_claims,
    check_clock,
    check_commands,
    check_controllers,
    check_description,
    check_hardware,
    check_joint_states,
    check_node_names,
    check_publishers,
    check_qos,
    check_real_time_factor,
)
from arm_cli.doctor.verb import examine_running, is_healthy

MANAGER = "/controller_manager"
URDF = '<robot name="r"><link name="base"/></robot>'
ACTIVE = LoadedController("position_controller", "active", ("j0/position",))
HARDWARE = ObservedHardware("arm", "active", {"j0/position": True, "j0/velocity": False})
HEALTHY = GraphObservation(
    managers=(ControlState(MANAGER, True, (ACTIVE,), (HARDWARE,)),),
    publishers={"/clock": ("/arm_gazebo",), "/joint_states": ("/joint_state_broadcaster",)},
    descriptions={"/robot_description": URDF},
    clock=ClockReading(1.0, 1.0, 1.0),
    joint_states=(StateTopic("/joint_states", ("/joint_state_broadcaster",), (), 100),),
    commands=(SetpointTopic("/position_controller/commands", (), ("/position_controller",)),),
)


def with_manager(*controllers, hardware=(HARDWARE,), name=MANAGER, answered=True):
    return GraphObservation(managers=(ControlState(name, answered, controllers, hardware),))


def says(check, observation, severity, sentence, fix=""):
    finding = check(observation)
    assert finding.severity == severity, finding
    assert sentence in finding.sentence
    assert fix in finding.fix
    assert finding.fix or severity == Severity.OK


def test_a_healthy_simulation_has_no_fault():
    findings = examine_running(HEALTHY)
    assert [f for f in findings if f.severity is not Severity.OK] == []
    assert is_healthy(findings)
    assert len({finding.check for finding in findings}) == 11


def test_without_a_simulation_there_is_no_fault():
    [finding] = examine_running(GraphObservation())
    assert finding.severity is Severity.OK
    assert "arm launch" in finding.fix


@pytest.mark.parametrize(
    ("found", "sentence"),
    [
        ({}, "nobody publishes /robot_description"),
        ({"/left/robot_description": ""}, "/left/robot_description has a publisher, but"),
        ({"/robot_description": "<robot>"}, "is not a URDF: no element found"),
        ({"/robot_description": "<sdf/>"}, "its root element is <sdf>"),
        ({"/robot_description": "<robot/>"}, "it has no <link>"),
    ],
)
def test_description(found, sentence):
    says(check_description, GraphObservation(descriptions=found), "error", sentence)


def test_inactive_hardware_is_reported_with_its_manager():
    resting = with_manager(hardware=(ObservedHardware("arm", "inactive"),), name="/left/manager")
    fix = "set_hardware_component_state arm active -c /left/manager"
    says(check_hardware, resting, "error", "arm is inactive", fix)
    says(check_hardware, with_manager(hardware=()), "error", "has no hardware", "ros2_control")


def test_controllers():
    inactive = LoadedController("position_controller", "inactive")
    new = LoadedController("position_controller", "unconfigured")
    command = "arm control set_controller_state position_controller"
    displayed, simulated = GraphObservation(), GraphObservation(publishers={"/clock": ("/sim",)})
    says(check_controllers, displayed, "warning", "there is no controller manager", "arm launch")
    says(check_controllers, simulated, "error", "there is no controller manager", "arm launch")
    says(check_controllers, with_manager(), "error", "has loaded no controllers", "spawner")
    says(check_controllers, with_manager(ACTIVE, inactive), "warning", "is inactive", command)
    says(check_controllers, with_manager(new), "warning", "is unconfigured", f"{command} inactive")
    says(check_controllers, with_manager(answered=False), "error", "does not answer")


def test_a_silent_manager_takes_precedence_over_an_inactive_controller():
    resting = ControlState("/a", controllers=(LoadedController("c", "inactive"),))
    observation = GraphObservation(managers=(resting, ControlState("/b", answered=False)))
    says(check_controllers, observation, "error", "/b does not answer")


def test_joints_without_commands():
    free = ObservedHardware("arm", "active", {"j0/position": False, "j0/effort": False})
    half = ObservedHardware("arm", "active", {"j0/position": True, "j1/position": False})
    resting = LoadedController("position_controller", "inactive")
    activate = "switch_controllers --activate position_controller"
    says(check_claims, with_manager(resting, hardware=(free,)), "error", "nothing can", activate)
    says(check_claims, with_manager(ACTIVE, hardware=(half,)), "warning", "commands j1", "spawner")


@pytest.mark.parametrize(
    ("clock", "sentence"),
    [(None, "no message arrives"), (ClockReading(0.0, 1.0), "its time does not change")],
)
def test_a_clock_that_stands_still_is_an_error(clock, sentence):
    observation = GraphObservation(publishers={"/clock": ("/sim",)}, clock=clock)
    says(check_clock, observation, "error", sentence)


def test_nodes_that_wait_for_a_missing_clock():
    waiting = GraphObservation(publishers={"/clock": ()}, clock_readers=("/watcher",))
    sentence = "time stands still for nodes that use it: /watcher"
    says(check_clock, waiting, "error", sentence, "use_sim_time")
    says(check_controllers, waiting, "error", "there is no controller manager")
    assert len(examine_running(waiting)) > 1


LISTENED_TO = StateTopic("/joint_states", (), ("/robot_state_publisher",))
SILENT = StateTopic("/joint_states", ("/jsb",), ("/robot_state_publisher",))
WATCHED = StateTopic("/joint_states", (), ("/arm_viewer",))
COMING = StateTopic("/left/joint_states", ("/left/jsb",), (), 3)


@pytest.mark.parametrize(
    ("topics", "severity", "sentence"),
    [
        ((), "error", "nobody publishes /joint_states: the arm is displayed at rest"),
        ((LISTENED_TO,), "error", "/joint_states, to which /robot_state_publisher subscribes"),
        ((SILENT,), "error", "/joint_states is published by /jsb, but no message arrives"),
        ((SILENT, COMING), "warning", "/joint_states is published by /jsb, but no message arrives"),
        ((LISTENED_TO, COMING), "warning", "nobody publishes /joint_states, to which"),
        ((COMING,), "ok", "they arrive on /left/joint_states"),
        ((WATCHED, COMING), "ok", "they arrive on /left/joint_states"),
        ((WATCHED,), "error", "nobody publishes /joint_states, to which /arm_viewer subscribes"),
    ],
)
def test_joint_states(topics, severity, sentence):
    says(check_joint_states, GraphObservation(joint_states=topics), severity, sentence)


def test_remains_of_an_ended_simulation_are_not_healthy():
    # The remains of arm launch when the simulation hangs: no other node uses /clock.
    left = GraphObservation(descriptions={"/robot_description": URDF}, joint_states=(LISTENED_TO,))
    assert not is_healthy(examine_running(left))


def test_without_a_clock_nodes_use_the_system_clock():
    says(check_clock, GraphObservation(), "ok", "nodes use the system clock")


@pytest.mark.parametrize(
    ("reading", "severity", "sentence"),
    [
        (ClockReading(0.5, 1.0, 1.0), "warning", "0.50 instead of 1"),
        (ClockReading(0.5, 1.0, 0.5), "ok", "0.50 of 0.5"),
        (ClockReading(9.0, 1.0, 0.0), "ok", "9.00, as fast as possible"),
        (ClockReading(0.5, 1.0, None), "ok", "0.50"),
    ],
)
def test_real_time_factor(reading, severity, sentence):
    says(check_real_time_factor, GraphObservation(clock=reading), severity, sentence)


def test_mismatches_are_named_and_the_rest_is_counted():
    found = tuple(Mismatch(f"/t{i}", "/a", "/b", "too little") for i in range(5))
    sentence = "/t0 from /a to /b: too little"
    says(check_qos, GraphObservation(mismatches=found), "warning", sentence, "info -v /t0")
    assert check_qos(GraphObservation(mismatches=found)).sentence.endswith("and 2 more")


@pytest.mark.parametrize("topic", ["/clock", "/joint_states", "/left/joint_states"])
def test_a_second_publisher_is_an_error(topic):
    observation = GraphObservation(publishers={topic: ("/a", "/b")})
    says(check_publishers, observation, "error", f"{topic} is published by /a and /b")


def test_two_publishers_of_any_other_topic_are_ok():
    says(check_publishers, GraphObservation(publishers={"/tf": ("/a", "/b")}), "ok", "no second")


def test_a_name_that_several_nodes_have_is_a_warning():
    sentence = "/arm is the name of several nodes"
    says(
        check_node_names,
        GraphObservation(nodes=("/arm", "/b", "/arm")),
        "warning",
        sentence,
        "replace:=",
    )
    two = GraphObservation(nodes=("/b", "/arm", "/b", "/arm", "/arm"))
    says(check_node_names, two, "warning", "/arm and /b are the names of several nodes")
    says(check_node_names, GraphObservation(nodes=("/arm", "/left/arm")), "ok", "no two nodes")


COMMANDS = "/c/commands"


@pytest.mark.parametrize(
    ("topic", "severity", "sentence"),
    [
        (SetpointTopic(COMMANDS, ("/me",)), "warning", "but nobody subscribes"),
        (
            SetpointTopic(COMMANDS, ("/me",), ("/c",), "c", "inactive", 3),
            "error",
            "published by /me, but c is inactive",
        ),
        (SetpointTopic(COMMANDS, ("/me",), ("/c",), "c", "inactive", 0), "ok", "none arrived"),
        (SetpointTopic(COMMANDS, ("/me",), ("/c",), "c", "active", 3), "ok", "commands arrive on"),
        (
            SetpointTopic(COMMANDS, ("/me",), ("/c",), "c", "active", 1, ahead_s=1.7e9),
            "error",
            "1700000000 s ahead of the simulation's time",
        ),
        (
            SetpointTopic(COMMANDS, ("/me",), ("/c",), "c", "active", 1, -5.0, lasting_s=2.0),
            "error",
            "is stale: it ended 3.0 s ago",
        ),
        (
            SetpointTopic(COMMANDS, ("/me",), ("/c",), "c", "active", 1, -1.0, lasting_s=2.0),
            "ok",
            "commands arrive on",
        ),
    ],
)
def test_commands(topic, severity, sentence):
    says(check_commands, GraphObservation(commands=(topic,)), severity, sentence)


NAN_POSITION = StateTopic("/joint_states", ("/jsb",), (), 3, ("j0/position", "j1/effort"))


def test_joint_states_that_are_not_numbers_are_an_error():
    offers = ObservedHardware("arm", "active", {}, ("j0/position", "j1/position"))
    says(
        check_joint_states,
        GraphObservation(
            (ControlState(MANAGER, hardware=(offers,)),), joint_states=(NAN_POSITION,)
        ),
        "error",
        "j0/position is not a number on /joint_states",
        "list_hardware_interfaces",
    )
    says(
        check_joint_states,
        GraphObservation(joint_states=(NAN_POSITION,)),
        "error",
        "j0/position is not a number",
        "driver",
    )


def test_a_state_that_the_hardware_lacks_may_be_nan():
    offers = ObservedHardware("arm", "active", {}, ("j0/velocity", "j1/position"))
    observation = GraphObservation(
        (ControlState(MANAGER, hardware=(offers,)),), joint_states=(NAN_POSITION,)
    )
    says(check_joint_states, observation, "ok", "they arrive on /joint_states")


def test_a_latched_emergency_stop():
    stopped = replace(HEALTHY, stopped=("/emergency_stop/active",))
    says(check_controllers, stopped, "error", "an emergency stop is latched", "arm stop --release")
