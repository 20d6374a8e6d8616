"""Calls of real servers: answers, silence, feedback, cancel, parameters and subscribers."""

import time

import pytest
import rclpy
from control_msgs.action import FollowJointTrajectory
from rcl_interfaces.msg import IntegerRange, ParameterDescriptor, SetParametersResult
from rclpy.action.server import ActionServer, CancelResponse
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import Float64
from std_srvs.srv import SetBool

from arm_viewer.calls.call import Callee, CallKind, EndCall, OpenForm, PlaceCall
from arm_viewer.ros import service_call
from arm_viewer.ros.call_desk import CallDesk

pytestmark = pytest.mark.ros

TIMEOUT_S = 60.0
SERVICE = Callee(CallKind.SERVICE, "/switch", "std_srvs/srv/SetBool")
SILENT = Callee(CallKind.SERVICE, "/silent", "std_srvs/srv/SetBool")
ACTION = Callee(CallKind.ACTION, "/follow", "control_msgs/action/FollowJointTrajectory")
TOPIC = Callee(CallKind.TOPIC, "/speed", "std_msgs/msg/Float64")
PARAMETERS = Callee(CallKind.PARAMETERS, "/robot", "")


class Robot:
    """A node that offers something of each kind; its goals end when they are cancelled."""

    def __init__(self, context):
        self.node = rclpy.create_node("robot", context=context)
        self.speeds, self.goals = [], []
        self.node.create_service(SetBool, "switch", self._switch)
        self.node.create_subscription(Float64, "speed", self.speeds.append, 10)
        limits = ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=9)])
        self.node.declare_parameter("gear", 3, limits)
        self.node.declare_parameter("name", "robot")
        self.node.add_on_set_parameters_callback(self._judge)
        self.action = ActionServer(
            self.node,
            FollowJointTrajectory,
            "follow",
            execute_callback=self._follow,
            handle_accepted_callback=self.goals.append,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )

    def _switch(self, request, response):
        response.success, response.message = request.data, "as you wish"
        return response

    def _follow(self, goal):
        goal.canceled()
        return FollowJointTrajectory.Result(error_string="left off")

    def _judge(self, parameters):
        refused = any(p.value == "no" for p in parameters)
        return SetParametersResult(successful=not refused, reason="not that name" * refused)


class World:
    """The desk beside the robot; one thread spins both."""

    def __init__(self):
        self.context = Context()
        rclpy.init(context=self.context)
        self.robot = Robot(self.context)
        # Nobody spins it, so that it answers nothing.
        self.mute = rclpy.create_node("mute", context=self.context)
        self.mute.create_service(SetBool, "silent", lambda request, response: response)
        self.node = rclpy.create_node("page", context=self.context)
        self.desk = CallDesk(self.node)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.robot.node)
        self.executor.add_node(self.node)
        self.number = 0

    def until(self, condition):
        """Spin until a function returns something; return it."""
        deadline_s = time.monotonic() + TIMEOUT_S
        while not (found := condition()):
            assert time.monotonic() < deadline_s, dict(self.desk.states)
            self.executor.spin_once(timeout_sec=0.02)
            self.desk.collect(time.monotonic())
        return found

    def begin(self, request, *fields):
        """Send a request; return a function that returns what has become of it."""
        self.number += 1
        number = self.number
        self.desk.serve(request(number, *fields))
        return lambda: self.desk.states[number]

    def end_of(self, request, *fields):
        """Send a request; return what has become of it in the end."""
        state = self.begin(request, *fields)
        self.until(lambda: state().is_over)
        return state()


@pytest.fixture(scope="module")
def world():
    made = World()
    yield made
    made.executor.shutdown()
    made.robot.action.destroy()
    made.robot.node.destroy_node()
    made.mute.destroy_node()
    made.node.destroy_node()
    made.context.try_shutdown()


def test_everything_of_a_node_is_listed(world):
    def listed():
        world.desk.discover(dict(world.node.get_topic_names_and_types()))
        return {SERVICE, ACTION, TOPIC, PARAMETERS} <= set(world.desk.callees)

    world.until(listed)
    names = [callee.name for callee in world.desk.callees]
    assert not [name for name in names if "/_" in name or name.endswith("/get_parameters")]


def test_a_service_answers(world):
    form = world.end_of(OpenForm, SERVICE).form
    assert [(field.path, field.text) for field in form] == [("data", "false")]
    state = world.end_of(PlaceCall, SERVICE, {"data": "true"})
    assert (state.answer, state.is_failed) == ("success: true\nmessage: as you wish\n", False)
    assert world.end_of(PlaceCall, SERVICE, {}).is_failed


def test_what_does_not_fit_is_refused_before_anything_is_sent(world):
    state = world.end_of(PlaceCall, SERVICE, {"data": "perhaps"})
    assert state.is_failed
    assert state.text == "data: 'perhaps' is neither true nor false (bool)"


def test_a_type_that_is_not_installed_is_named(world):
    state = world.end_of(OpenForm, Callee(CallKind.SERVICE, "/x", "strange_msgs/srv/Thing"))
    assert state.is_failed
    assert "/x has the type strange_msgs/srv/Thing, which cannot be used here" in state.text


def test_a_service_without_a_server_is_said_to_have_none(world, monkeypatch):
    monkeypatch.setattr(service_call, "FIND_S", 0.0)
    state = world.end_of(PlaceCall, Callee(CallKind.SERVICE, "/gone", SERVICE.type), {})
    assert state.text == "no server offers /gone"


def test_a_silent_service_is_given_up_by_itself_or_by_its_user(world, monkeypatch):
    monkeypatch.setattr(service_call, "KNOWN_S", 0.0)
    stopped = world.begin(PlaceCall, SILENT, {})
    world.desk.serve(EndCall(world.number))
    world.until(lambda: stopped().is_over)
    assert "the server may still carry it out" in stopped().text
    monkeypatch.setattr(service_call, "ANSWER_S", 0.0)
    state = world.end_of(PlaceCall, SILENT, {})
    assert state.text == "/silent has not answered within 0 s"


def test_a_goal_shows_feedback_and_is_cancelled(world):
    state = world.begin(PlaceCall, ACTION, {"goal_time_tolerance": "{sec: 2}"})
    world.until(lambda: world.robot.goals)
    (goal,) = world.robot.goals
    assert goal.request.goal_time_tolerance.sec == 2
    world.until(lambda: state().text.startswith("Accepted"))

    def shows_feedback():
        goal.publish_feedback(FollowJointTrajectory.Feedback(joint_names=["elbow"]))
        return "- elbow" in state().answer

    world.until(shows_feedback)
    world.desk.serve(EndCall(world.number))
    world.until(lambda: goal.is_cancel_requested)
    goal.execute()
    world.until(lambda: state().is_over)
    assert state().text.startswith("Canceled after")
    assert "left off" in state().answer
    assert state().is_failed


def test_a_message_is_published_once_or_until_it_is_stopped(world):
    state = world.end_of(PlaceCall, TOPIC, {"data": "0.5"})
    assert state.text == "Published once, to 1 subscription"
    world.until(lambda: world.robot.speeds)
    assert [message.data for message in world.robot.speeds] == [0.5]
    begun = world.begin(PlaceCall, TOPIC, {"data": "2"}, 50.0)
    world.until(lambda: len(world.robot.speeds) > 5)
    world.desk.serve(EndCall(world.number))
    world.until(lambda: begun().is_over)
    assert begun().text.endswith("times, to 1 subscription")
    world.until(lambda: world.node.count_publishers("/speed") == 0)


def test_parameters_are_read_with_their_ranges_and_set(world):
    fields = {field.path: field for field in world.end_of(OpenForm, PARAMETERS).form}
    assert (fields["gear"].text, fields["gear"].least, fields["gear"].most) == ("3", 0, 9)
    state = world.end_of(PlaceCall, PARAMETERS, {"gear": "5", "name": "no"})
    assert state.is_failed
    assert state.text == "name: not that name"
    assert world.robot.node.get_parameter("gear").value == 5
    assert world.end_of(PlaceCall, PARAMETERS, {"gear": "4"}).text == "Set 1 of 1"
    refused = world.end_of(PlaceCall, PARAMETERS, {"gear": "fast"})
    assert refused.text == "gear: 'fast' is not a value of the type integer"


def test_too_many_calls_at_a_time_are_refused(world, monkeypatch):
    monkeypatch.setattr("arm_viewer.ros.call_desk.MAX_CALLS", 1)
    first = world.begin(PlaceCall, TOPIC, {}, 1.0)
    assert "1 calls are under way" in world.end_of(PlaceCall, TOPIC, {}).text
    world.desk.serve(EndCall(world.number - 1))
    world.until(lambda: first().is_over)
