"""Managed nodes: their transitions in the plan, and with a real node over real ROS."""

import sys

import pytest

from launch_py import EmitEvent, LogInfo, RegisterEventHandler
from launch_py.errors import LaunchFileError
from launch_py.events import matches_action
from launch_py.plan.readiness import LogLine
from launch_py.ros import ChangeState, LifecycleNode, LifecycleTransition, OnStateTransition
from launch_py.ros.lifecycle import matches_node_name
from launch_py.testing import FakeChild

CLIENT = (sys.executable, "-P", "-m", "launch_py.ros.lifecycle_client")


def managed(name: str = "talker", **options) -> LifecycleNode:
    return LifecycleNode(executable="true", name=name, namespace="demo", **options)


def change(node: LifecycleNode, transition: int) -> EmitEvent:
    return EmitEvent(
        event=ChangeState(lifecycle_node_matcher=matches_action(node), transition_id=transition)
    )


def transitions(node: LifecycleNode, **options) -> RegisterEventHandler:
    return RegisterEventHandler(OnStateTransition(target_lifecycle_node=node, **options))


def test_a_change_of_state_is_a_process_that_waits_for_the_node(expand):
    node = managed()
    plan = expand([node, change(node, 1)])
    assert [step.name for step in plan.processes] == ["talker", "configure /demo/talker"]
    asked = plan.processes[1]
    assert asked.command == (*CLIENT, "change", "/demo/talker", "1")
    assert [trigger.process for trigger in asked.after] == ["talker"]


@pytest.mark.parametrize("name", ["", None])
def test_a_managed_node_without_a_name_is_refused(expand, name):
    with pytest.raises(LaunchFileError, match="a LifecycleNode needs a name"):
        expand([LifecycleNode(executable="true", name=name)])


def test_matchers_select_the_nodes(expand):
    a, b = managed("a"), managed("b")
    by_name = ChangeState(lifecycle_node_matcher=matches_node_name("/demo/b"), transition_id=3)
    every = ChangeState(lifecycle_node_matcher=lambda _node: True, transition_id=1)
    plan = expand([a, b, EmitEvent(event=every), EmitEvent(event=by_name)])
    assert [step.name for step in plan.processes[2:]] == [
        "configure /demo/a",
        "configure /demo/b",
        "activate /demo/b",
    ]


def test_an_automatic_start_and_several_transitions(expand):
    plan = expand(
        [
            managed("a", autostart=True),
            managed("b"),
            LifecycleTransition(lifecycle_node_names=["/demo/b"], transition_ids=[1, "3"]),
        ]
    )
    named = {step.name: step.command[-3:] for step in plan.processes}
    assert named["configure activate /demo/a"] == ("/demo/a", "1", "3")
    assert named["configure activate /demo/b"] == ("/demo/b", "1", "3")


def test_the_actions_follow_each_transition_that_fits(trial):
    node = managed()
    t = trial(
        transitions(node, goal_state="inactive", entities=[LogInfo(msg="inactive")]),
        transitions(
            node,
            start_state="activating",
            transition="activate",
            handle_once=True,
            entities=lambda event, _: LogInfo(msg=f"{event.goal_state} {event.action is node}"),
        ),
        node,
        change(node, 1),
    )
    watcher: FakeChild = t["transitions of /demo/talker"]
    assert "configure /demo/talker" not in t.started
    watcher.write("watching")
    assert t.started[-1] == "configure /demo/talker"
    for line in ("configuring inactive unnamed", "activating active activate") * 2:
        watcher.write(line)
    assert t.screen.lines.count("inactive") == 2
    assert t.screen.lines.count("active True") == 1
    assert t.started.count("transitions of /demo/talker") == 1


def test_without_a_node_every_managed_node_is_watched(expand):
    every = RegisterEventHandler(OnStateTransition(goal_state="active", entities=[]))
    plan = expand([managed("a"), managed("b"), every])
    watchers = [step for step in plan.processes if step.ready == (LogLine(pattern="^watching$"),)]
    assert {step.command[-1] for step in watchers} == {"/demo/a", "/demo/b"}


@pytest.mark.parametrize(
    ("action", "said"),
    [
        (
            EmitEvent(event=ChangeState(lifecycle_node_matcher=lambda _: True, transition_id=77)),
            "ChangeState: no transition 77; 0 create, 1 configure",
        ),
        (
            EmitEvent(event=ChangeState(lifecycle_node_matcher=lambda _: False, transition_id=1)),
            "ChangeState: its matcher fits no LifecycleNode before it",
        ),
        (
            LifecycleTransition(lifecycle_node_names=["/demo/talkr"], transition_ids=[1]),
            "no node /demo/talkr; did you mean '/demo/talker'",
        ),
        (
            LifecycleTransition(lifecycle_node_names=["/demo/talker"], transition_ids=[77]),
            "LifecycleTransition: no transition 77",
        ),
        (
            LifecycleTransition(lifecycle_node_names=["/demo/talker"], transition_ids=["one"]),
            "LifecycleTransition: no transition one",
        ),
    ],
)
def test_what_does_not_exist_is_named(expand, action, said):
    with pytest.raises(LaunchFileError) as caught:
        expand([managed(), action])
    assert said in str(caught.value)


NODE = """
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.lifecycle import LifecycleNode

rclpy.init()
try:
    rclpy.spin(LifecycleNode("talker"))
except (KeyboardInterrupt, ExternalShutdownException):
    pass
"""


@pytest.mark.ros
def test_a_real_node_is_configured_activated_and_heard(launch, tmp_path):
    program = tmp_path / "talker.py"
    program.write_text(NODE)
    launched = launch(
        f"""
        from launch_py.events import Shutdown as ShutdownEvent, matches_action
        from launch_py.ros import ChangeState, LifecycleNode, OnStateTransition

        node = LifecycleNode(
            executable=sys.executable, arguments=[{str(program)!r}], name="talker", namespace="demo"
        )

        def change(number):
            return EmitEvent(event=ChangeState(
                lifecycle_node_matcher=matches_action(node), transition_id=number))

        def on(goal, *entities):
            return RegisterEventHandler(OnStateTransition(
                target_lifecycle_node=node, goal_state=goal, entities=list(entities)))

        actions = [
            on("inactive", LogInfo(msg="it is inactive"), change(3)),
            on("active", LogInfo(msg="it is active"), EmitEvent(event=ShutdownEvent())),
            node,
            change(1),
        ]
        """
    )
    launched.wait_for("it is inactive")
    launched.wait_for("it is active")
    assert launched.wait() == 0
