"""Sends a jog's motion to a controller, as a trajectory or as an array."""

import logging
from collections.abc import Callable
from typing import Any

import numpy as np
from controller_manager_msgs.srv import ListControllers
from numpy.typing import NDArray
from rclpy.node import Node
from std_msgs.msg import Float64MultiArray
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from arm_planning.ros.convert import duration_message, stamp_message
from arm_planning.servo.jog import JogStep
from arm_planning.servo.settings import TRAJECTORY, ServoSettings

Array = NDArray[np.float64]

CONTROLLER = "joint_trajectory_controller/JointTrajectoryController"
DEPTH = 10
LEAST_STOP_S = 0.1
"""A controller refuses a trajectory that comes after its end."""
LOGGER = logging.getLogger("servo_node")


class ServoOutput:
    """Publishes commands. Executor's thread.

    A trajectory goes on after its period with the joints' coming to rest: a robot whose commands
    end, for whatever reason, stops without a jerk and not later than the jog would have stopped it.
    `stop_s` returns how long the joints take to stop from their speeds.
    """

    def __init__(
        self,
        node: Node,
        joints: tuple[str, ...],
        settings: ServoSettings,
        stop_s: Callable[[Array], float],
    ) -> None:
        self._node, self._joints, self._settings = node, joints, settings
        self._stop_s = stop_s
        self._publisher: Any = None
        self._is_trajectory = settings.command_out_type == TRAJECTORY
        self._controllers: Any = None
        if settings.command_out_topic:
            self._open(settings.command_out_topic)
        elif self._is_trajectory:
            self._controllers = node.create_client(
                ListControllers, "controller_manager/list_controllers"
            )

    @property
    def problem(self) -> str:
        """Why nothing can be commanded; "" if it can."""
        if self._publisher is not None:
            return ""
        if not self._is_trajectory:
            return "moveit_servo.command_out_topic is empty: give the topic of the array"
        return (
            f"no active {CONTROLLER} drives {', '.join(self._joints)}; start one, or give "
            "moveit_servo.command_out_topic"
        )

    def look_for_controller(self) -> None:
        """Ask the controller manager for the joints' controller, until there is one."""
        if self._publisher is None and self._controllers is not None:
            if not self._controllers.service_is_ready():
                return
            future = self._controllers.call_async(ListControllers.Request())
            future.add_done_callback(lambda done: self._choose(done.result()))

    def publish(self, before: Array, step: JogStep, stamp_s: float, period_s: float) -> None:
        """Publish a step from the positions `before`, (n,), at a time on the node's clock."""
        settings = self._settings
        if not self._is_trajectory:
            values = step.positions if settings.publish_joint_positions else step.speeds
            self._publisher.publish(Float64MultiArray(data=values.tolist()))
            return
        message = JointTrajectory(joint_names=list(self._joints))
        message.header.stamp = stamp_message(stamp_s)
        message.points = [
            self._point(0.0, before, step.speeds),
            self._point(period_s, step.positions, step.speeds),
        ]
        stop_s = max(self._stop_s(step.speeds), LEAST_STOP_S)
        rest = step.positions + step.speeds * stop_s / 2.0
        message.points.append(self._point(period_s + stop_s, rest, np.zeros_like(rest)))
        self._publisher.publish(message)

    def _point(self, time_s: float, positions: Array, speeds: Array) -> JointTrajectoryPoint:
        settings = self._settings
        return JointTrajectoryPoint(
            positions=positions.tolist() if settings.publish_joint_positions else [],
            velocities=speeds.tolist() if settings.publish_joint_velocities else [],
            time_from_start=duration_message(time_s),
        )

    def _open(self, topic: str) -> None:
        kind = JointTrajectory if self._is_trajectory else Float64MultiArray
        self._publisher = self._node.create_publisher(kind, topic, DEPTH)
        LOGGER.info("commands go to %s", self._publisher.topic_name)

    def _choose(self, answer: Any) -> None:
        if answer is None or self._publisher is not None:
            return
        for each in answer.controller:
            driven = {name.rpartition("/")[0] for name in each.claimed_interfaces}
            if each.type == CONTROLLER and each.state == "active" and driven >= set(self._joints):
                self._open(f"{each.name}/joint_trajectory")
                return
