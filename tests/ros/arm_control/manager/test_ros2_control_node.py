"""The stand-alone controller manager in a separate process, with mock hardware."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from control_msgs.msg import MultiDOFCommand, MultiDOFStateStamped
from lifecycle_msgs.msg import State
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, String
from std_srvs.srv import SetBool

BROADCASTER = "joint_state_broadcaster/JointStateBroadcaster"
JOINTS = ("j0", "j1")
STRICT = 2

MOCK = "<hardware><plugin>mock_components/GenericSystem</plugin></hardware>"
JOINT = (
    "<joint name='{0}'><command_interface name='position'/>"
    "<state_interface name='position'><param name='initial_value'>0.25</param></state_interface>"
    "<state_interface name='velocity'/></joint>"
)
LINKS = "<link name='base_link'/>" + "".join(
    f"<link name='{name}_link'/><joint name='{name}' type='continuous'>"
    f"<parent link='base_link'/><child link='{name}_link'/></joint>"
    for name in (*JOINTS, "lift")
)
ARM = f"<ros2_control name='Arm' type='system'>{MOCK}{''.join(map(JOINT.format, JOINTS))}"
ARM += "</ros2_control>"
LIFT = f"<ros2_control name='Lift' type='actuator'>{MOCK}{JOINT.format('lift')}</ros2_control>"
SCALE = (
    f"<ros2_control name='Scale' type='sensor' rw_rate='50' is_async='true'>{MOCK}"
    "<sensor name='scale'><state_interface name='weight'/></sensor></ros2_control>"
)


def robot(*components: str) -> str:
    return f"<robot name='r'>{LINKS}{''.join(components)}</robot>"


PARAMETERS = {
    "controller_manager": {
        "ros__parameters": {
            "robot_description": robot(ARM, LIFT, SCALE),
            "thread_priority": 20,
            "hardware_components_initial_state": {"unconfigured": ["Lift"]},
            "jsb.type": BROADCASTER,
            "arm.type": "position_controllers/JointGroupPositionController",
            "lift.type": "position_controllers/JointGroupPositionController",
            "pid.type": "pid_controller/PidController",
            "top.type": "forward_command_controller/ForwardCommandController",
        }
    },
    "arm": {"ros__parameters": {"joints": list(JOINTS)}},
    "lift": {"ros__parameters": {"joints": ["lift"]}},
    "pid": {
        "ros__parameters": {
            "dof_names": list(JOINTS),
            "command_interface": "position",
            "reference_and_state_interfaces": ["position"],
            "gains": {"j0": {"p": 1.0}, "j1": {"p": 2.0}},
        }
    },
    "top": {"ros__parameters": {"joints": ["pid/j0", "pid/j1"], "interface_name": "position"}},
}


def start(
    run: Callable[..., Any], folder: Path, parameters: dict[str, Any], *ros_arguments: str
) -> Any:
    file = folder / "controllers.yaml"
    file.write_text(yaml.safe_dump(parameters))
    return run(
        "-m",
        "arm_control.manager.ros2_control_node",
        "--ros-args",
        "--params-file",
        str(file),
        *ros_arguments,
    )


@pytest.fixture(scope="module")
def manager(run, tmp_path_factory):
    """Return the module's manager, its robot given by parameter."""
    return start(run, tmp_path_factory.mktemp("parameters"), PARAMETERS)


@pytest.fixture
def component(control) -> Callable[[str], Any]:
    """Return a function that looks a component up."""

    def look_up(name: str) -> Any:
        components = control.call("list_hardware_components").component
        return next(c for c in components if c.name == name)

    return look_up


@pytest.fixture
def set_state(control) -> Callable[..., Any]:
    """Return a function that sets a component's state."""

    def set_(name: str, **state: Any) -> Any:
        return control.call("set_hardware_component_state", name=name, target_state=State(**state))

    return set_


# The description


@pytest.fixture(scope="module")
def waiting(run, tmp_path_factory):
    """Return a manager in a namespace that uses /clock and waits for its description."""
    parameters = {"/waiting/controller_manager": {"ros__parameters": {"jsb.type": BROADCASTER}}}
    return start(
        run,
        tmp_path_factory.mktemp("waiting"),
        parameters,
        *("-r", "__ns:=/waiting", "-p", "use_sim_time:=true"),
    )


@pytest.fixture
def describe(client, latched) -> Callable[[str], None]:
    """Return a function that publishes a description for the waiting manager."""
    publisher = client.node.create_publisher(String, "/waiting/robot_description", latched)
    return lambda text: publisher.publish(String(data=text))


def test_a_robot_is_waited_for_until_a_description_can_be_used(
    waiting, client, describe, control_of
):
    def services() -> set[str]:
        return {
            name.rpartition("/")[2]
            for name, _ in client.node.get_service_names_and_types_by_node(
                "controller_manager", "/waiting"
            )
        }

    waiting.wait_for_line("Waiting for data on 'robot_description' topic to finish initialization")
    client.wait_until(
        lambda: ("controller_manager", "/waiting") in client.node.get_node_names_and_namespaces(),
        "the node",
    )
    client.wait_until(lambda: "set_parameters" in services(), "its own services")
    assert "list_controllers" not in services()
    describe("<robot")
    waiting.wait_for_line(
        "The robot description cannot be used: robot_description, line 1: not XML"
    )
    describe(robot())
    waiting.wait_for_line("it has no <ros2_control> block")
    describe(robot(ARM.replace("mock_components/GenericSystem", "no/Such")))
    waiting.wait_for(r"no hardware plugin 'no/Such'; known: .*mock_components/GenericSystem")
    describe(robot(ARM, LIFT.replace("'lift'", "'j0'")))
    waiting.wait_for_line("interface 'j0/position' already belongs to hardware component 'Arm'")
    assert "list_controllers" not in services()
    describe(robot(ARM))
    assert control_of("/waiting").states() == {}
    describe(robot(SCALE))
    waiting.wait_for_line("Ignoring attempt to reload a robot description.")
    (component,) = control_of("/waiting").call("list_hardware_components").component
    assert (component.name, component.state.label) == ("Arm", "active")


def test_with_use_sim_time_it_uses_the_clock_topic(waiting, client, describe, control_of):
    describe(robot(ARM))
    control = control_of("/waiting")
    # Before the first /clock time stands still, and all of this works.
    control.start("jsb")
    states = client.subscribe(JointState, "/waiting/joint_states")
    clock = client.publisher(Clock, "/clock")
    client.wait_until(lambda: clock.get_subscription_count() >= 3, "listeners of /clock")
    client.wait_until(lambda: client.node.count_publishers("/waiting/joint_states"), "states")
    sent: list[int] = []

    def advance(milliseconds: int) -> None:
        sent.append((sent[-1] if sent else 5_000) + milliseconds)
        message = Clock()
        message.clock.sec, rest = divmod(sent[-1], 1000)
        message.clock.nanosec = rest * 1_000_000
        clock.publish(message)

    def stamps() -> list[int]:
        return [
            m.header.stamp.sec * 1000 + m.header.stamp.nanosec // 1_000_000 for m in states.messages
        ]

    while len(states.messages) < 10:
        before = len(states.messages)
        advance(10)
        client.wait_until(
            lambda n=before: len(states.messages) > n or not n, "a cycle for each step of the clock"
        )
    assert set(stamps()) <= set(sent)
    # A step that is shorter than a period is not one of its cycles.
    advance(10)
    client.wait_until(lambda: stamps()[-1] == sent[-1], "the last cycle")
    advance(2)
    advance(8)
    client.wait_until(lambda: stamps()[-1] == sent[-1], "the next cycle")
    assert sent[-2] not in stamps()
    # And back in time it goes on from there.
    sent.append(1_000)
    advance(10)
    client.wait_until(lambda: stamps()[-1] == 1_010, "a cycle after the clock was set back")
    control.unload_all()
    assert waiting.stop() == 0
    assert "Traceback" not in waiting.output


def test_a_description_by_parameter_is_deprecated(manager, control):
    manager.wait_for_line("[Deprecated] Passing the robot description parameter directly")
    assert control.states() == {}


def test_its_loop_runs_at_the_requested_priority(manager, client):
    threads = Path(f"/proc/{manager.process.pid}/task")

    def raised() -> bool:
        # Field 40 and 41 of stat(5), counted after the command name: priority and policy.
        try:
            texts = [(thread / "stat").read_text() for thread in threads.iterdir()]
        except OSError:  # One has just ended.
            return False
        stats = [text.rpartition(")")[2] for text in texts]
        return [("20", str(os.SCHED_FIFO))] == [
            (fields[37], fields[38]) for fields in map(str.split, stats) if fields[38] != "0"
        ]

    refused = "runs without SCHED_FIFO priority 20"
    client.wait_until(
        lambda: raised() or refused in manager.output, "the priority, or that it is refused"
    )
    assert raised() != (refused in manager.output)


# Hardware


def test_components_start_in_their_initial_states(component):
    assert [
        (c.name, c.type, c.state.label, c.plugin_name, c.rw_rate, c.is_async)
        for c in map(component, ("Arm", "Lift", "Scale"))
    ] == [
        ("Arm", "system", "active", "mock_components/GenericSystem", 100, False),
        ("Lift", "actuator", "unconfigured", "mock_components/GenericSystem", 100, False),
        ("Scale", "sensor", "active", "mock_components/GenericSystem", 50, True),
    ]
    assert [i.name for i in component("Arm").command_interfaces] == ["j0/position", "j1/position"]
    assert [i.is_available for i in component("Lift").state_interfaces] == [False, False]


def test_inactive_hardware_is_watched_but_not_commanded(control, set_state):
    set_state("Lift", label="inactive")
    try:
        control.start("jsb")
        control.load("lift")
        control.configure("lift")
        assert control.switch(["lift"]).message == (
            "Could not switch controllers since prepare command mode switch was rejected."
        )
    finally:
        set_state("Lift", label="unconfigured")


# Controllers


def test_cleanup_controller(control):
    def clean_up(name: str) -> bool:
        return control.call("cleanup_controller", name=name).ok

    assert not clean_up("nothing")
    control.load("arm")
    assert clean_up("arm")
    control.configure("arm")
    assert clean_up("arm")
    assert control.states() == {"arm": "unconfigured"}
    control.configure("arm")
    control.switch(["arm"])
    assert not clean_up("arm")
    assert control.states() == {"arm": "active"}


def test_a_chain_of_controllers(control, client):
    for name in ("top", "pid"):
        control.load(name)
        assert control.configure(name)
    top, pid = control.list()
    assert (top.name, pid.name) == ("top", "pid")
    assert (top.is_chainable, pid.is_chainable, pid.is_chained) == (False, True, False)
    references = ["j0/position", "j1/position"]
    assert pid.reference_interfaces == pid.exported_state_interfaces == references
    assert top.required_command_interfaces == ["pid/j0/position", "pid/j1/position"]
    assert [(c.name, list(c.reference_interfaces)) for c in top.chain_connections] == [
        ("pid", references)
    ]
    interfaces = control.call("list_hardware_interfaces")
    assert {"pid/j0/position": False, "pid/j1/position": False}.items() <= {
        i.name: i.is_available for i in interfaces.command_interfaces
    }.items()

    assert not control.switch(["top"]).ok
    assert control.switch(["pid"]).ok
    assert control.switch(["top"]).ok
    assert [c.is_chained for c in control.list()] == [False, True]
    assert control.list()[0].claimed_interfaces == ["pid/j0/position", "pid/j1/position"]
    assert not control.switch([], ["pid"]).ok

    state = client.subscribe(MultiDOFStateStamped, "/pid/controller_state")
    commands = client.publisher(Float64MultiArray, "/top/commands")
    commands.publish(Float64MultiArray(data=[3.0, 4.0]))
    message = state.wait_until(
        lambda m: [d.reference for d in m[-1].dof_states] == [3.0, 4.0] if m else False,
        "the references",
    )[-1]
    assert [d.name for d in message.dof_states] == list(JOINTS)
    assert message.dof_states[0].error == 3.0 - message.dof_states[0].feedback
    assert control.switch([], ["top", "pid"]).ok


def test_references_come_by_topic_unless_a_controller_commands(control, client):
    control.start("pid")
    state = client.subscribe(MultiDOFStateStamped, "/pid/controller_state")
    references = client.publisher(MultiDOFCommand, "/pid/reference")
    references.publish(MultiDOFCommand(dof_names=["j1", "j0"], values=[2.0, 1.0]))
    state.wait_until(
        lambda m: [d.reference for d in m[-1].dof_states] == [1.0, 2.0] if m else False,
        "the references",
    )
    request = SetBool.Request(data=True)
    assert client.call(SetBool, "/pid/set_feedforward_control", request).success


def test_ctrl_c_ends_it_with_code_0(manager, control_of, client):
    control_of("").start("jsb", "arm")
    assert manager.stop(2) == 0
    assert "Traceback" not in manager.output
