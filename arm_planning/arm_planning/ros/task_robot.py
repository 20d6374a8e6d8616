"""The running robot as tasks need it: its planner, its scene, and the execution of solutions."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from moveit_msgs.action import ExecuteTrajectory
from moveit_msgs.msg import AttachedCollisionObject, MoveItErrorCodes
from moveit_msgs.msg import CollisionObject as ObjectMessage
from moveit_msgs.msg import PlanningScene as SceneMessage
from moveit_msgs.srv import ApplyPlanningScene, GetPlanningScene
from rclpy.action.client import ActionClient
from rclpy.node import Node
from rclpy.task import Future
from std_msgs.msg import String

from arm_description.resources import ResourceFinder
from arm_description.urdf.parser import parse_urdf
from arm_node.process import NodeProcess
from arm_node.qos import LATCHED
from arm_planning.configuration import PLANNING, SEMANTIC, move_group_parameters
from arm_planning.errors import ControlError, InvalidObjectError, MoveItErrorCode, PlanningError
from arm_planning.planner import Planner
from arm_planning.planners.pilz.cartesian_limits import cartesian_limits
from arm_planning.robot.build import planning_model
from arm_planning.robot.limits import joint_limit_settings
from arm_planning.robot.model import PlanningModel
from arm_planning.robot.srdf import parse_srdf
from arm_planning.ros.convert import trajectory_message
from arm_planning.ros.convert_scene import (
    attached_message,
    matrix_message,
    object_message,
    scene_change_of,
)
from arm_planning.ros.plan_display import PlanDisplay
from arm_planning.ros.robot_setup import URDF
from arm_planning.scene.objects import CollisionObject
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.scene_changes import change_scene
from arm_planning.tasks.solution import Solution

POLL_S, REMINDER_S = 0.02, 10.0


class TaskRobot:
    """Speaks with move_group. Each method blocks, on a thread that does not spin the node.

    Attributes:
        planner: plans in this process, in the scene that move_group had when it was asked.
    """

    def __init__(self, node: Node, process: NodeProcess, configuration: str) -> None:
        """Wait for move_group, and get its robot and its scene.

        The robot's limits are those of a MoveIt configuration, a folder or a URI.

        Raises:
            PlanningError: the configuration or the robot cannot be used, or the process ends.
            DescriptionError: the URDF cannot be used.
        """
        self._node, self._process = node, process
        self._texts: dict[str, str] = {}
        subscriptions = [
            node.create_subscription(String, name, partial(self._take, name), LATCHED)
            for name in (URDF, SEMANTIC)
        ]
        self._execute = ActionClient(node, ExecuteTrajectory, "execute_trajectory")
        self._get = node.create_client(GetPlanningScene, "get_planning_scene")
        self._apply = node.create_client(ApplyPlanningScene, "apply_planning_scene")
        self._wait("no move_group: does it run with planning:=true?", self._is_connected)
        # The executor fails if one disappears while it collects what to wait for.
        for subscription in subscriptions:
            process.executor.create_task(node.destroy_subscription, subscription)
        self.planner = self._planner(configuration)
        self._display = PlanDisplay(node, self.planner.model)

    def add(self, objects: Sequence[CollisionObject]) -> None:
        """Put objects into the scene; one of the same name is replaced.

        Raises:
            PlanningError: move_group refuses one.
        """
        frame = self.planner.model.frame
        self.add_messages([object_message(each, frame) for each in objects])

    def add_messages(self, objects: Sequence[ObjectMessage]) -> None:
        """Do the same with messages, whose frames move_group must know.

        Raises:
            PlanningError: move_group refuses one.
        """
        message = self._difference()
        message.world.collision_objects = objects
        self._change(message)
        self.planner.scene = self._scene(self.planner.scene, self.planner.model)

    def call(self, kind: type[Any], name: str, request: object, server: str) -> Any:
        """Return a service's answer, once its server is there; the user is reminded of that node.

        Raises:
            PlanningError: PREEMPTED: the process ends.
        """
        client = self._node.create_client(kind, name)
        self._wait(f"no {server}, which has {name}: does it run?", client.service_is_ready)
        return self._answer(client.call_async, request)

    def show(self, solution: Solution) -> None:
        """Publish the motions of a solution for RViz and the page."""
        motions = [step.trajectory for step in solution.steps]
        self._display.show(solution.start.positions, motions)

    def execute(self, solution: Solution) -> None:
        """Move the robot, and change move_group's scene, step by step.

        Raises:
            PlanningError: a step failed, or the process ends; the robot stands still.
        """
        for step in solution.steps:
            try:
                if step.trajectory is None:
                    self._follow_change(step.start, step.end)
                else:
                    message = trajectory_message(self.planner.model.frame, step.trajectory)
                    self._run(ExecuteTrajectory.Goal(trajectory=message))
            except PlanningError as error:
                raise PlanningError(error.code, f"stage '{step.stage}': {error}") from error

    def _planner(self, configuration: str) -> Planner:
        finder = ResourceFinder.of_description(self._texts[URDF])
        given = move_group_parameters(finder.find(configuration)).get(PLANNING, {})
        robot = parse_urdf(self._texts[URDF])
        semantic = parse_srdf(self._texts[SEMANTIC], robot)
        model = planning_model(robot, semantic, joint_limit_settings(given, self._warn), self._warn)
        planner = Planner(model, resources=finder, tip_limits=cartesian_limits(given))
        planner.scene = self._scene(planner.scene, model)
        return planner

    def _scene(self, before: PlanningScene, model: PlanningModel) -> PlanningScene:
        """Return the scene that move_group has now."""
        answer = self._answer(self._get.call_async, GetPlanningScene.Request())
        change = scene_change_of(model, answer.scene, self._warn)
        outcome = change_scene(model, before, change, self._warn)
        if outcome.problems:
            raise outcome.problems[0]
        return outcome.scene

    def _follow_change(self, before: PlanningScene, after: PlanningScene) -> None:
        """Change move_group's scene as a stage has changed it."""
        message = self._difference()
        attached: list[AttachedCollisionObject] = []
        for name, body in after.attached.items():
            if name not in before.attached:
                change = attached_message(body)
                # Without shapes, the object of the world is taken, where it is.
                change.object = ObjectMessage(id=name, operation=ObjectMessage.ADD)
                attached.append(change)
        for name, body in before.attached.items():
            if name not in after.attached:
                change = AttachedCollisionObject(link_name=body.link)
                change.object = ObjectMessage(id=name, operation=ObjectMessage.REMOVE)
                attached.append(change)
        message.robot_state.attached_collision_objects = attached
        if after.allowed != before.allowed:
            message.allowed_collision_matrix = matrix_message(after.allowed)
        if attached or after.allowed != before.allowed:
            self._change(message)

    def _difference(self) -> SceneMessage:
        message = SceneMessage(is_diff=True)
        message.robot_state.is_diff = True
        return message

    def _change(self, message: SceneMessage) -> None:
        request = ApplyPlanningScene.Request(scene=message)
        if not self._answer(self._apply.call_async, request).success:
            raise InvalidObjectError(
                "move_group did not take the change of the scene; its log says why"
            )

    def _run(self, goal: ExecuteTrajectory.Goal) -> None:
        handle = self._answer(self._execute.send_goal_async, goal)
        if not handle.accepted:
            raise ControlError("move_group did not take the goal")
        try:
            code = self._answer(handle.get_result_async).result.error_code
        except PlanningError:
            handle.cancel_goal_async()
            raise
        if code.val != MoveItErrorCodes.SUCCESS:
            message = code.message or f"move_group failed with code {code.val}"
            raise PlanningError(MoveItErrorCode(code.val), message)

    def _is_connected(self) -> bool:
        servers = (self._execute.server_is_ready, self._get.service_is_ready)
        ready = all(is_ready() for is_ready in (*servers, self._apply.service_is_ready))
        return ready and len(self._texts) == 2

    def _answer(self, ask: Callable[..., Future], *request: object) -> Any:
        """Return the answer to a request, sent on the executor's thread.

        From another thread, the answer may come before rclpy has noted whose it is, and be lost.
        """

        async def answer() -> Any:
            return await ask(*request)

        task = self._process.executor.create_task(answer)
        self._wait("", lambda: task.done() or not self._execute.server_is_ready())
        if not task.done():
            raise PlanningError(MoveItErrorCode.COMMUNICATION_FAILURE, "move_group is gone")
        return task.result()

    def _wait(self, what: str, is_over: Callable[[], bool]) -> None:
        """Wait, and remind the user of what is waited for.

        Raises:
            PlanningError: PREEMPTED: the process ends.
        """
        waited_s = 0.0
        while not is_over():
            if self._process.wait(POLL_S):
                raise PlanningError(MoveItErrorCode.PREEMPTED, "it was interrupted")
            waited_s += POLL_S
            if what and waited_s >= REMINDER_S:
                waited_s = 0.0
                self._node.get_logger().warning(what)

    def _warn(self, sentence: str) -> None:
        self._node.get_logger().warning(sentence)

    def _take(self, name: str, message: String) -> None:
        self._texts[name] = message.data
