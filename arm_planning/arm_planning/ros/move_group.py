"""The node move_group: everything that MoveIt's clients talk to."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from moveit_msgs.srv import GetGroupUrdf
from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import Empty

from arm_node.executor_thread import ExecutorThread
from arm_node.qos import LATCHED
from arm_planning.errors import MoveItErrorCode
from arm_planning.execution import EXECUTION, ExecutionSettings, controllers_of_settings
from arm_planning.ros.answering import (
    BusyLimit,
    QuickExecutor,
    QuickServices,
    SlowExecutor,
    offer_service,
)
from arm_planning.ros.controller_list import ControllerList
from arm_planning.ros.convert import error_code
from arm_planning.ros.geometry_files import GeometryFiles
from arm_planning.ros.goals import Turns
from arm_planning.ros.motion_goals import PLANS, MotionGoals, MoveActions
from arm_planning.ros.octomap_updater import OctomapUpdater, octomap_settings
from arm_planning.ros.plan_display import PlanDisplay
from arm_planning.ros.planner_parameters import PlannerParameterServices
from arm_planning.ros.planning_services import PlanningServices, StateServices
from arm_planning.ros.planning_session import PlanningSession
from arm_planning.ros.robot_setup import PlanningSetup, switch_of, values_below
from arm_planning.ros.scene_monitor import SceneMonitor
from arm_planning.ros.sequence_server import SequenceServer
from arm_planning.ros.trajectory_executor import ExecutionManager

SERVICES = 8
"""Services that plan, at the same time."""
THREADS = SERVICES + PLANS + 8
"""More than all that may wait at the same time: one is left to cancel goals."""
LOGGER = logging.getLogger("move_group")


class MoveGroup:
    """Connects the planner to ROS: two nodes, as upstream.

    `node` serves what may take long, on threads of its own; `scene_node` has the scene's topics.
    """

    def __init__(self, node: Node, scene_node: Node, setup: PlanningSetup) -> None:
        self._model = setup.model
        self._node = node
        self.monitor = SceneMonitor(scene_node, setup.model, setup.scene, setup.meshes, node)
        if setup.in_world is not None:
            self.monitor.follow_world(scene_node, setup.in_world)
        session = PlanningSession(setup, self.monitor)
        settings = ExecutionSettings.read(values_below(node, EXECUTION))
        controllers = ControllerList(
            node, controllers_of_settings(values_below(node, "moveit_simple_controller_manager"))
        )
        executor = ExecutionManager(node, self.monitor.states, controllers.available, settings)
        display = PlanDisplay(node, setup.model)
        allows_execution = switch_of(node, "allow_trajectory_execution", default=True)
        motions = MotionGoals(
            session, executor, display, allows_execution, moving=Turns(), planning=Turns(PLANS)
        )
        limit = BusyLimit(SERVICES)
        self._quick = QuickServices()
        self._served = (
            MoveActions(node, motions),
            SequenceServer(node, motions, limit),
            PlanningServices(node, session, display, limit),
            StateServices(node, session, limit, self._quick),
            PlannerParameterServices(node, session.parameters, setup.model),
            GeometryFiles(node, setup.model, self.monitor),
        )
        self._semantic = node.create_publisher(String, "robot_description_semantic", LATCHED)
        self._semantic.publish(String(data=setup.srdf))
        self._executor = executor
        self._motions = motions
        scene_node.create_subscription(String, "trajectory_execution_event", self._take_event, 10)
        offer_service(node, GetGroupUrdf, "get_urdf", self._urdf)
        octomap = octomap_settings(values_below(node, ""))
        self._octomap = (
            None
            if octomap is None
            else OctomapUpdater(node, self.monitor, setup.model, setup.meshes, octomap)
        )
        offer_service(node, Empty, "clear_octomap", self._clear_octomap)

    @contextmanager
    def serving(self) -> Iterator[None]:
        """Serve what may take long on threads of their own; at the end the robot stops."""
        slow = SlowExecutor(THREADS)
        slow.add_node(self._node)
        threads = (
            ExecutorThread("planning", slow),
            ExecutorThread("quick answers", QuickExecutor(self._node, self._quick)),
        )
        for thread in threads:
            thread.start()
        try:
            yield
        finally:
            for turns in (self._motions.moving, self._motions.planning):
                turns.stop()
            self._executor.end()
            for thread in threads:
                thread.stop()

    def _take_event(self, event: String) -> None:
        if event.data == "stop":
            self._motions.moving.stop()
            self._executor.stop()
        else:
            LOGGER.warning("Unknown event type: '%s'; there is 'stop'", event.data)

    def _clear_octomap(self, _request: Any, answer: Empty.Response) -> Empty.Response:
        if self._octomap is not None:
            self._octomap.clear()
        elif self.monitor.scene.octomap is None:
            LOGGER.warning("the scene has no octomap to clear")
        self.monitor.set_octomap(None)
        return answer

    def _urdf(self, request: Any, answer: GetGroupUrdf.Response) -> GetGroupUrdf.Response:
        self._model.group(request.group_name)
        answer.urdf_string = str(self._node.get_parameter("robot_description").value)
        answer.error_code = error_code(MoveItErrorCode.SUCCESS)
        return answer
