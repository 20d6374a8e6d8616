"""One move_group: its robot, the goal that the page has chosen, plans and motions."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial

from rclpy.node import Node

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_planning.robot.model import JointPositions, PlanningModel
from arm_viewer.planning import GoalState, PlanningView, filled
from arm_viewer.requests import (
    AddObject,
    DragTip,
    ExecutePlan,
    JogTip,
    PlanMotion,
    PlanningRequest,
    RemoveObject,
    SetGoal,
    StopMotion,
)
from arm_viewer.ros.goal_checker import GoalChecker
from arm_viewer.ros.motion_caller import MotionCaller
from arm_viewer.ros.planning_scene_client import PlanningSceneClient
from arm_viewer.ros.tip_jogger import TipJogger, is_served
from arm_viewer.ros.tip_solver import TipPose, TipSolver
from arm_viewer.snapshot import SimulationTime


class ObservedMoveGroup:
    """Use it in the executor's thread.

    Attributes:
        view: what the page shows; a new object after each change.
    """

    def __init__(
        self,
        node: Node,
        polled: PolledSubscriptions,
        namespace: str,
        model: PlanningModel,
        present: Callable[[], Mapping[str, float]],
        clock: Callable[[], SimulationTime | None],
    ) -> None:
        """Create the clients; without a simulation, `clock` returns None."""
        self.view = PlanningView(namespace, model)
        self._make_jogger = partial(TipJogger, node, polled, namespace, model, clock)
        self._jogger: TipJogger | None = None
        self._model = model
        self._present = present
        self._node = node
        self._motions = MotionCaller(node, polled, namespace, model)
        self._checker = GoalChecker(node, namespace, self._take_checked)
        self._scene = PlanningSceneClient(node, polled, namespace, model)
        self._solver = TipSolver(node, namespace, self._seed, self._take_solved)
        self._planned: PlanMotion | None = None

    def serve(self, request: PlanningRequest) -> None:
        """Do what the user wants."""
        match request:
            case SetGoal():
                self._set_goal(request.group, request.positions)
            case DragTip():
                self._drag(request)
            case JogTip():
                if self._jogger is not None:
                    self._jogger.jog(request)
            case PlanMotion() if self._solver.is_busy:
                # It is meant for the pose that was set before, whose goal is still sought.
                self._planned = request
            case PlanMotion():
                self._motions.start(self.view.goal, request)
            case ExecutePlan():
                self._motions.execute()
            case StopMotion():
                self._planned = None
                self._motions.stop()
            case AddObject():
                self._scene.add(request.object)
            case RemoveObject():
                self._scene.remove(request.name)

    def collect(self) -> None:
        """Take what has arrived."""
        self._solver.ask()
        self._checker.ask()
        self._motions.collect()
        self._scene.collect()
        jogger = self._jogger
        if jogger is not None:
            jogger.collect()
        motions, scene = self._motions, self._scene
        view = replace(
            self.view,
            plan=motions.plan,
            activity=motions.activity,
            said=motions.said,
            failed=motions.failed,
            scene=scene.scene,
            scene_problem=scene.problem,
            jog=None if jogger is None else jogger.view,
        )
        # By identity, because scenes may be large.
        if view.scene is not self.view.scene and view.goal is not None:
            self._checker.check(view.goal)
        self.view = view

    def check(self) -> None:
        """End what is late, and look for a servo_node; call it periodically."""
        self._motions.check()
        is_there = is_served(self._node, self.view.namespace)
        if is_there and self._jogger is None:
            self._jogger = self._make_jogger()
        elif not is_there and self._jogger is not None:
            self._jogger.close()
            self._jogger = None

    def close(self) -> None:
        """Destroy the clients."""
        self._motions.close()
        self._checker.close()
        self._solver.close()
        self._scene.close()
        if self._jogger is not None:
            self._jogger.close()

    def _set_goal(self, name: str, positions: JointPositions) -> None:
        group = self._model.groups.get(name)
        if group is None:
            return
        goal = GoalState(name, filled(group, positions, self._present()))
        self._motions.drop_plan()
        self._keep(goal)
        self._checker.check(goal)

    def _drag(self, request: DragTip) -> None:
        group = self._model.groups.get(request.group)
        if group is not None and group.tip:
            root = self._model.robot.root
            wanted = TipPose(group.name, group.tip, root, request.pose, request.avoids)
            self._solver.solve(wanted)

    def _seed(self, name: str) -> JointPositions:
        """Return the goal of a group, or the present positions where it has none."""
        goal = self.view.goal
        known = goal.positions if goal is not None and goal.group == name else {}
        return filled(self._model.groups[name], known, self._present())

    def _take_solved(self, asked: TipPose, found: JointPositions | None, problem: str) -> None:
        if found is not None:
            self._set_goal(asked.group, found)
        else:
            goal = self.view.goal
            if goal is None or goal.group != asked.group:
                goal = GoalState(asked.group, self._seed(asked.group))
            self._keep(replace(goal, problem=problem))
        if self._planned is None or self._solver.is_busy:
            return
        planned, self._planned = self._planned, None
        if found is not None:
            self._motions.start(self.view.goal, planned)
        else:
            self._motions.refuse(f"Nothing was planned. {problem}")

    def _take_checked(self, checked: GoalState) -> None:
        goal = self.view.goal
        if goal is not None and (goal.group, goal.positions) == (checked.group, checked.positions):
            self._keep(replace(goal, colliding=checked.colliding, contacts=checked.contacts))

    def _keep(self, goal: GoalState) -> None:
        self.view = replace(self.view, goal=goal)
