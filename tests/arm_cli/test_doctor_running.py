"""`arm doctor` of a running simulation: what each check makes of what was seen."""

import pytest

from arm_cli.doctor.clock_advancing import ClockAdvancing
from arm_cli.doctor.commands_taken import CommandsTaken
from arm_cli.doctor.controllers_active import ControllersActive
from arm_cli.doctor.description_published import DescriptionPublished
from arm_cli.doctor.examination import examine_running, is_healthy
from arm_cli.doctor.finding import Severity
from arm_cli.doctor.hardware_active import HardwareActive
from arm_cli.doctor.joint_states_come import JointStatesCome
from arm_cli.doctor.joints_claimed import JointsClaimed
from arm_cli.doctor.observation import (
    ClockReading,
    CommandTopic,
    ControlState,
    HardwareComponent,
    LoadedController,
    Mismatch,
    Observation,
    StateTopic,
)
from arm_cli.doctor.qos_matches import QosMatches
from arm_cli.doctor.real_time_factor import RealTimeFactor
from arm_cli.doctor.single_publishers import SinglePublishers

MANAGER = "/controller_manager"
URDF = '<robot name="r"><link name="base"/></robot>'
ACTIVE = LoadedController("position_controller", "active", ("j0/position",))
HARDWARE = HardwareComponent("arm", "active", {"j0/position": True, "j0/velocity": False})
HEALTHY = Observation(
    managers=(ControlState(MANAGER, True, (ACTIVE,), (HARDWARE,)),),
    publishers={"/clock": ("/arm_gazebo",), "/joint_states": ("/joint_state_broadcaster",)},
    descriptions={"/robot_description": URDF},
    clock=ClockReading(1.0, 1.0, 1.0),
    joint_states=(StateTopic("/joint_states", ("/joint_state_broadcaster",), (), 100),),
    commands=(CommandTopic("/position_controller/commands", (), ("/position_controller",)),),
)


def with_manager(*controllers, hardware=(HARDWARE,), name=MANAGER, answered=True):
    return Observation(managers=(ControlState(name, answered, controllers, hardware),))


def says(check, observation, severity, sentence, fix=""):
    finding = check(observation).examine()
    assert finding.severity == severity, finding
    assert sentence in finding.sentence
    assert fix in finding.fix
    assert finding.fix or severity == Severity.OK


def test_a_healthy_simulation_has_no_fault():
    findings = examine_running(HEALTHY)
    assert [f for f in findings if f.severity is not Severity.OK] == []
    assert is_healthy(findings)
    assert len({finding.check for finding in findings}) == 10


def test_where_nothing_runs_nothing_is_wrong():
    [finding] = examine_running(Observation())
    assert finding.severity is Severity.OK
    assert "arm launch" in finding.fix


@pytest.mark.parametrize(
    ("found", "sentence"),
    [
        ({}, "nobody publishes /robot_description"),
        ({"/left/robot_description": ""}, "/left/robot_description has a publisher, but"),
        ({"/robot_description": "<robot>"}, "is no URDF: no element found"),
        ({"/robot_description": "<sdf/>"}, "its root element is <sdf>"),
        ({"/robot_description": "<robot/>"}, "it has no <link>"),
    ],
)
def test_description(found, sentence):
    says(DescriptionPublished, Observation(descriptions=found), "error", sentence)


def test_hardware_that_rests_is_named_with_its_manager():
    resting = with_manager(hardware=(HardwareComponent("arm", "inactive"),), name="/left/manager")
    fix = "set_hardware_component_state arm active -c /left/manager"
    says(HardwareActive, resting, "error", "arm is inactive", fix)
    says(HardwareActive, with_manager(hardware=()), "error", "has no hardware", "ros2_control")


def test_controllers():
    inactive = LoadedController("position_controller", "inactive")
    new = LoadedController("position_controller", "unconfigured")
    command = "arm control set_controller_state position_controller"
    displayed, simulated = Observation(), Observation(publishers={"/clock": ("/sim",)})
    says(ControllersActive, displayed, "warning", "there is no controller manager", "arm launch")
    says(ControllersActive, simulated, "error", "there is no controller manager", "arm launch")
    says(ControllersActive, with_manager(), "error", "has loaded no controllers", "spawner")
    says(ControllersActive, with_manager(ACTIVE, inactive), "warning", "is inactive", command)
    says(ControllersActive, with_manager(new), "warning", "is unconfigured", f"{command} inactive")
    says(ControllersActive, with_manager(answered=False), "error", "does not answer")


def test_a_manager_without_answer_counts_more_than_a_resting_controller():
    resting = ControlState("/a", controllers=(LoadedController("c", "inactive"),))
    observation = Observation(managers=(resting, ControlState("/b", answered=False)))
    says(ControllersActive, observation, "error", "/b does not answer")


def test_joints_that_nobody_commands():
    free = HardwareComponent("arm", "active", {"j0/position": False, "j0/effort": False})
    half = HardwareComponent("arm", "active", {"j0/position": True, "j1/position": False})
    resting = LoadedController("position_controller", "inactive")
    activate = "switch_controllers --activate position_controller"
    says(JointsClaimed, with_manager(resting, hardware=(free,)), "error", "nothing can", activate)
    says(JointsClaimed, with_manager(ACTIVE, hardware=(half,)), "warning", "commands j1", "spawner")


@pytest.mark.parametrize(
    ("clock", "sentence"),
    [(None, "nothing comes"), (ClockReading(0.0, 1.0), "always the same time")],
)
def test_a_clock_that_stands_still_is_an_error(clock, sentence):
    observation = Observation(publishers={"/clock": ("/sim",)}, clock=clock)
    says(ClockAdvancing, observation, "error", sentence)


def test_nodes_that_wait_for_a_clock_which_nobody_publishes():
    waiting = Observation(publishers={"/clock": ()}, clock_readers=("/watcher",))
    sentence = "time stands still for those who go by it: /watcher"
    says(ClockAdvancing, waiting, "error", sentence, "use_sim_time")
    says(ControllersActive, waiting, "error", "there is no controller manager")
    assert len(examine_running(waiting)) > 1


LISTENED_TO = StateTopic("/joint_states", (), ("/robot_state_publisher",))
SILENT = StateTopic("/joint_states", ("/jsb",), ("/robot_state_publisher",))
COMING = StateTopic("/left/joint_states", ("/left/jsb",), (), 3)


@pytest.mark.parametrize(
    ("topics", "severity", "sentence"),
    [
        ((), "error", "nobody publishes /joint_states: the arm is seen at rest"),
        ((LISTENED_TO,), "error", "/joint_states, which /robot_state_publisher listens to"),
        ((SILENT,), "error", "/joint_states is published by /jsb, but nothing comes"),
        ((SILENT, COMING), "warning", "/joint_states is published by /jsb, but nothing comes"),
        ((LISTENED_TO, COMING), "warning", "nobody publishes /joint_states, which"),
        ((COMING,), "ok", "they come on /left/joint_states"),
    ],
)
def test_joint_states(topics, severity, sentence):
    says(JointStatesCome, Observation(joint_states=topics), severity, sentence)


def test_where_the_simulation_is_gone_the_rest_is_not_healthy():
    # What is left of arm launch where the simulation hangs: nobody else knows of /clock.
    left = Observation(descriptions={"/robot_description": URDF}, joint_states=(LISTENED_TO,))
    assert not is_healthy(examine_running(left))


def test_without_a_clock_time_is_the_machines():
    says(ClockAdvancing, Observation(), "ok", "time is the machine's")


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
    says(RealTimeFactor, Observation(clock=reading), severity, sentence)


def test_mismatches_are_named_and_the_rest_is_counted():
    found = tuple(Mismatch(f"/t{i}", "/a", "/b", "too little") for i in range(5))
    sentence = "/t0 from /a to /b: too little"
    says(QosMatches, Observation(mismatches=found), "warning", sentence, "info -v /t0")
    assert QosMatches(Observation(mismatches=found)).examine().sentence.endswith("and 2 more")


@pytest.mark.parametrize("topic", ["/clock", "/joint_states", "/left/joint_states"])
def test_a_second_publisher_is_an_error(topic):
    observation = Observation(publishers={topic: ("/a", "/b")})
    says(SinglePublishers, observation, "error", f"{topic} is published by /a and /b")


def test_two_publishers_of_any_other_topic_are_right():
    says(SinglePublishers, Observation(publishers={"/tf": ("/a", "/b")}), "ok", "no second")


COMMANDS = "/c/commands"


@pytest.mark.parametrize(
    ("topic", "severity", "sentence"),
    [
        (CommandTopic(COMMANDS, ("/me",)), "warning", "but nobody listens"),
        (
            CommandTopic(COMMANDS, ("/me",), ("/c",), "c", "inactive", 3),
            "error",
            "published by /me, but c is inactive",
        ),
        (CommandTopic(COMMANDS, ("/me",), ("/c",), "c", "inactive", 0), "ok", "none came"),
        (CommandTopic(COMMANDS, ("/me",), ("/c",), "c", "active", 3), "ok", "commands come on"),
        (
            CommandTopic(COMMANDS, ("/me",), ("/c",), "c", "active", 1, ahead_s=1.7e9),
            "error",
            "1700000000 s ahead of the simulation's time",
        ),
        (
            CommandTopic(COMMANDS, ("/me",), ("/c",), "c", "active", 1, -5.0, lasting_s=2.0),
            "error",
            "is stale: it was over 3.0 s ago",
        ),
        (
            CommandTopic(COMMANDS, ("/me",), ("/c",), "c", "active", 1, -1.0, lasting_s=2.0),
            "ok",
            "commands come on",
        ),
    ],
)
def test_commands(topic, severity, sentence):
    says(CommandsTaken, Observation(commands=(topic,)), severity, sentence)
