"""What the page's node makes of a move_group that fails, falls silent or ends."""

from functools import partial

import pytest
from geometry_msgs.msg import PoseStamped
from moveit_msgs.action import ExecuteTrajectory, MoveGroup
from moveit_msgs.msg import ContactInformation, ServoStatus
from moveit_msgs.srv import GetPositionIK, GetStateValidity, ServoCommandType
from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

from arm_node.rigid_transform import RigidTransform
from arm_viewer.requests import DragTip, ExecutePlan, JogTip, PlanMotion, SetGoal

URDF = """<robot name='r'><link name='base'/><link name='arm'/>
  <joint name='turn' type='revolute'><parent link='base'/><child link='arm'/>
    <limit lower='-1' upper='1' effort='1' velocity='1'/></joint></robot>"""
SRDF = """<robot name='r'><group name='all'><joint name='turn'/></group>
  <group_state name='left' group='all'><joint name='turn' value='0.5'/></group_state></robot>"""
NAME, SILENT = "/fake", "/silent"


class FakeMoveGroup:
    """Serves as much of a move_group as a test wants, on a node that one may leave unspun."""

    def __init__(self, node, name) -> None:
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._node = node
        self._name = name
        self._services = []
        self.goals = []
        for topic, text in (("robot_description", URDF), ("robot_description_semantic", SRDF)):
            publisher = node.create_publisher(String, f"{name}/{topic}", latched)
            publisher.publish(String(data=text))

    def serve(self, kind, name, answer) -> None:
        self._services.append(self._node.create_service(kind, f"{self._name}/{name}", answer))

    def serve_action(self, action, name, answer) -> None:
        self.serve(action.Impl.SendGoalService, f"{name}/_action/send_goal", self._accept)
        self.serve(action.Impl.GetResultService, f"{name}/_action/get_result", answer)

    def _accept(self, request, answer):
        self.goals.append(request.goal)
        answer.accepted = True
        return answer

    def end(self) -> None:
        for service in self._services:
            self._node.destroy_service(service)
        self._services.clear()


def refuse_plan(_, answer):
    answer.result.error_code.val = -12
    answer.result.error_code.message = "goal is in collision: arm with box1, 3 mm deep"
    return answer


def solve(request, answer):
    """Turn the joint by the wanted height; nothing reaches below the ground."""
    height_m = request.ik_request.pose_stamped.pose.position.z
    if height_m < 0.0:
        answer.error_code.val = -31
        answer.error_code.message = "the pose is below the ground"
        return answer
    answer.error_code.val = 1
    answer.solution.joint_state.name = ["turn", "another"]
    answer.solution.joint_state.position = [height_m, 9.0]
    return answer


def touch(_, answer):
    contact = ContactInformation(contact_body_1="arm", contact_body_2="box1", body_type_2=1)
    contact.depth = 0.003
    answer.contacts = [contact]
    return answer


class FakeServo:
    """Takes poses once it is told to, as servo_node does."""

    def __init__(self, client) -> None:
        self.client, self.kinds = client, []
        self.targets = client.subscribe(PoseStamped, f"{NAME}/servo_node/pose_target_cmds")
        self.status = client.node.create_publisher(ServoStatus, f"{NAME}/servo_node/status", 10)
        self._services = [
            client.node.create_service(kind, f"{NAME}/servo_node/{name}", answer)
            for kind, name, answer in (
                (ServoCommandType, "switch_command_type", self._switch),
                (GetParameters, "get_parameters", self._answer_group),
            )
        ]

    def _switch(self, request, answer):
        self.kinds.append(request.command_type)
        answer.success = True
        return answer

    def _answer_group(self, request, answer):
        assert request.names == ["moveit_servo.move_group_name"]
        text = ParameterValue(type=ParameterType.PARAMETER_STRING, string_value="all")
        answer.values = [text]
        return answer

    def end(self) -> None:
        for service in self._services:
            self.client.node.destroy_service(service)


@pytest.fixture(scope="module")
def move_group(client_for_file, viewer):
    fake = FakeMoveGroup(client_for_file.node, NAME)
    fake.serve_action(MoveGroup, "move_action", refuse_plan)
    fake.serve_action(ExecuteTrajectory, "execute_trajectory", lambda _, answer: answer)
    fake.serve(GetStateValidity, "check_state_validity", touch)
    fake.serve(GetPositionIK, "compute_ik", solve)
    viewer.seen(lambda s: NAME in s.planning)
    return fake


@pytest.fixture
def ask(viewer):
    """Send a request, and wait until it shows in the view of its move_group."""

    def send(request, seen):
        viewer.node.send(request)
        return viewer.seen(lambda s: seen(s.planning[request.namespace]))

    return send


def chosen(name=NAME):
    return SetGoal(name, "all", {"turn": 0.5})


def planned(name=NAME):
    return PlanMotion(name, 1.0, 1.0, executes=False)


def test_groups_and_named_poses_come_from_the_semantic_description(move_group, viewer):
    model = viewer.node.latest().planning[NAME].model
    assert model.state("all", "left") == {"turn": 0.5}


def test_without_a_goal_or_a_plan_it_says_what_is_missing(move_group, ask):
    view = ask(planned(), lambda view: view.said and view)
    assert "Choose a goal first" in view.said
    view = ask(ExecutePlan(NAME), lambda view: "no plan" in view.said and view)
    assert view.failed


def test_a_goal_in_collision_names_what_touches(move_group, ask):
    goal = ask(chosen(), lambda view: view.goal and view.goal.contacts and view.goal)
    assert goal.sentence == "The goal is in collision: arm with box1, 3 mm deep"
    assert goal.colliding == {"arm"}


def test_the_goal_follows_the_tip_and_stays_where_it_cannot(move_group, ask):
    high, low = (DragTip(NAME, "all", RigidTransform((0.0, 0.0, z))) for z in (0.25, -0.25))
    goal = ask(high, lambda view: view.goal and view.goal.positions["turn"] == 0.25 and view.goal)
    assert (goal.positions, goal.problem) == ({"turn": 0.25}, "")
    goal = ask(low, lambda view: view.goal.problem and view.goal)
    assert goal.problem == "The tip cannot be there: the pose is below the ground"
    assert goal.positions == {"turn": 0.25}
    goal = ask(high, lambda view: not view.goal.problem and view.goal)
    assert goal.positions == {"turn": 0.25}


def test_a_plan_leads_to_the_pose_that_was_set_right_before_it(move_group, viewer, ask):
    ask(chosen(), lambda view: view.goal and view.goal.positions["turn"] == 0.5)
    move_group.goals.clear()
    viewer.node.send(DragTip(NAME, "all", RigidTransform((0.0, 0.0, 0.75))))
    viewer.node.send(planned())
    viewer.until(lambda: move_group.goals)
    (wanted,) = move_group.goals[0].request.goal_constraints
    assert [joint.position for joint in wanted.joint_constraints] == [0.75]
    viewer.seen(lambda s: "GOAL_IN_COLLISION" in s.planning[NAME].said)
    viewer.node.send(DragTip(NAME, "all", RigidTransform((0.0, 0.0, -0.75))))
    view = ask(planned(), lambda view: view.said.startswith("Nothing was planned") and view)
    assert view.said.endswith("The tip cannot be there: the pose is below the ground")
    assert len(move_group.goals) == 1, "nothing was asked for"
    ask(chosen(), lambda view: not view.said)


def test_the_robot_follows_poses_of_its_tip_while_a_servo_node_runs(
    move_group, viewer, client_for_file
):
    assert viewer.node.latest().planning[NAME].jog is None
    servo = FakeServo(client_for_file)
    jog = viewer.seen(lambda s: s.planning[NAME].jog)
    assert (jog.group, jog.said) == ("all", "")
    drag = JogTip(NAME, RigidTransform((0.1, 0.2, 0.3)), 1)
    viewer.until(lambda: servo.targets.messages, lambda: viewer.node.send(drag))
    assert servo.kinds == [2]
    target = servo.targets.messages[-1]
    assert (target.header.frame_id, target.pose.position.z) == ("base", 0.3)
    assert target.header.stamp.sec > 1e9, "without a simulation the time is that of the wall"
    status = ServoStatus(code=ServoStatus.HALT_FOR_COLLISION, message="arm with box1")
    jog = viewer.seen(
        lambda s: s.planning[NAME].jog.said and s.planning[NAME].jog,
        lambda: servo.status.publish(status),
    )
    assert (jog.said, jog.is_stopped) == ("arm with box1", True)
    again = JogTip(NAME, RigidTransform(), 2)
    viewer.until(lambda: len(servo.kinds) == 2, lambda: viewer.node.send(again))
    servo.end()
    viewer.seen(lambda s: s.planning[NAME].jog is None)


def test_a_failed_plan_says_why_in_full(move_group, ask):
    ask(chosen(), lambda view: view.goal)
    view = ask(planned(), lambda view: view.failed and view)
    assert view.failed
    assert view.said == "goal is in collision: arm with box1, 3 mm deep (GOAL_IN_COLLISION)"
    assert view.plan is None


def test_a_move_group_that_never_answers_is_said_to_and_one_that_ends_is_gone(viewer, ask):
    # Nobody spins this node.
    node = Node("silent", context=viewer.context)
    fake = FakeMoveGroup(node, SILENT)
    for action, name in ((MoveGroup, "move_action"), (ExecuteTrajectory, "execute_trajectory")):
        fake.serve_action(action, name, partial(pytest.fail, "it is spun"))
    viewer.seen(lambda s: SILENT in s.planning)
    ask(chosen(SILENT), lambda view: view.goal)
    view = ask(planned(SILENT), lambda view: view.failed and view)
    assert view.said == f"{SILENT}/move_action does not answer"
    fake.end()
    viewer.seen(lambda s: SILENT not in s.planning)
    node.destroy_node()
