"""The octomap of the scene, made from depth cameras' points."""

import logging
import threading
from functools import partial
from typing import Any

import numpy as np
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import PointCloud2

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.qos import NEWEST
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.body_filter import BodyFilter
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.errors import PlanningError
from arm_planning.perception.occupancy import OccupancyGrid
from arm_planning.robot.model import PlanningModel
from arm_planning.ros.octomap_settings import OctomapSensor, OctomapSettings
from arm_planning.ros.point_clouds import points_of
from arm_planning.ros.scene_monitor import SceneMonitor
from arm_planning.scene.frames import LinkPoses, frame_pose
from arm_planning.scene.occupancy_map import OccupancyMap
from arm_planning.scene.scene import PlanningScene

LOGGER = logging.getLogger("move_group")


class OctomapUpdater:
    """Keeps the scene's octomap up to date.

    The work is done on one of the threads of the node's executor; no other thread uses `meshes`.
    """

    def __init__(
        self,
        node: Node,
        monitor: SceneMonitor,
        model: PlanningModel,
        meshes: MeshPieces,
        settings: OctomapSettings,
    ) -> None:
        self._monitor, self._model, self._settings = monitor, model, settings
        self._grid = OccupancyGrid(settings.resolution_m)
        self._map: OccupancyMap | None = None
        self._said = ""
        self._lock = threading.Lock()
        """Clearing comes on another thread."""
        self._polled = PolledSubscriptions(node)
        # Not on simulation time: a map grows while the robot's clock stands still, too.
        steady, group = Clock(clock_type=ClockType.STEADY_TIME), MutuallyExclusiveCallbackGroup()
        for sensor in settings.sensors:
            subscription = self._polled.subscribe(PointCloud2, sensor.topic, NEWEST)
            bodies = BodyFilter(model, meshes, sensor.scale, sensor.padding_m)
            update = partial(self._update, sensor, subscription, bodies)
            node.create_timer(1.0 / sensor.rate_hz, update, callback_group=group, clock=steady)

    def clear(self) -> None:
        """Forget all that was seen. Any thread."""
        with self._lock:
            self._grid.clear()
            self._map = None

    def _update(self, sensor: OctomapSensor, subscription: Any, bodies: BodyFilter) -> None:
        for raw, _ in self._polled.take(subscription, 1):
            cloud: PointCloud2 = deserialize_message(raw, PointCloud2)
            try:
                with self._lock:
                    self._see(sensor, cloud, bodies)
            except PlanningError as error:
                self._say(f"sensor '{sensor.name}' makes no octomap: {error}")
            else:
                self._said = ""

    def _see(self, sensor: OctomapSensor, cloud: PointCloud2, bodies: BodyFilter) -> None:
        step = sensor.subsample
        points = points_of(cloud)[::step, ::step]
        frame = cloud.header.frame_id
        scene = self._monitor.current()
        known = self._monitor.with_frames(scene, (frame, self._settings.frame))
        links = LinkPoses(self._model, scene.positions)
        origin = frame_pose(known, links, self._settings.frame)
        camera = frame_pose(known, links, frame)
        with np.errstate(invalid="ignore"):
            near = np.linalg.norm(points, axis=2) < sensor.max_range_m
        placed = _placed(camera, points[near].astype(np.float64))
        near[near] = ~bodies.inside(placed, scene)
        self._grid.see(points, origin.inverse().then(camera), near)
        # What was seen before may be in an object that is known now.
        self._grid.remove(bodies.inside(_placed(origin, self._grid.centres()), scene))
        self._publish(scene, origin)

    def _publish(self, scene: PlanningScene, origin: RigidTransform) -> None:
        cubes, before = self._grid.cubes(), self._map
        if (
            before is None
            or scene.octomap is not before
            or origin != before.pose
            or not np.array_equal(before.cubes.corners, cubes.corners)
        ):
            self._map = OccupancyMap(self._settings.resolution_m, cubes, origin)
            self._monitor.set_octomap(self._map)

    def _say(self, sentence: str) -> None:
        """Log a problem once, until it is over."""
        if sentence != self._said:
            LOGGER.error("%s", sentence)
            self._said = sentence


def _placed(frame: RigidTransform, points: np.ndarray) -> np.ndarray:
    """Return points (n, 3) of a frame in the one outside of it."""
    matrix = np.array(frame.matrix())
    return points @ matrix[:3, :3].T + matrix[:3, 3]
