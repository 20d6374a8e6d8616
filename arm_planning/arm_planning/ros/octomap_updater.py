"""The octomap of the scene, made from depth cameras' points, and its parameters, MoveIt's."""

import logging
import threading
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.node import Node
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import PointCloud2

from arm_node.names import describe_known
from arm_node.polled_subscriptions import PolledSubscriptions
from arm_node.qos import NEWEST
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.body_filter import BodyFilter
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.errors import PlanningError, SettingError
from arm_planning.perception.occupancy import OccupancyGrid
from arm_planning.robot.model import PlanningModel
from arm_planning.ros.point_clouds import points_of
from arm_planning.ros.scene_monitor import SceneMonitor
from arm_planning.scene.frames import LinkPoses, frame_pose
from arm_planning.scene.occupancy_map import OccupancyMap
from arm_planning.scene.scene import PlanningScene
from arm_planning.setting_values import number

LOGGER = logging.getLogger("move_group")
PLUGIN = "occupancy_map_monitor/PointCloudOctomapUpdater"
RESOLUTION_M = 0.1
"""As upstream, where nothing is given."""


@dataclass(frozen=True, slots=True)
class OctomapSensor:
    """A depth camera whose points make the octomap.

    Attributes:
        name: its name in the parameters.
        topic: of its point clouds, whose rows and columns are those of a picture.
        max_range_m: points farther away are left out.
        subsample: every how many rows and columns are used.
        padding_m: by which the robot and the objects are grown before they are cut out.
        scale: factor of their size before that.
        rate_hz: how often it is read.
    """

    name: str
    topic: str
    max_range_m: float
    subsample: int
    padding_m: float
    scale: float
    rate_hz: float


@dataclass(frozen=True, slots=True)
class OctomapSettings:
    """What makes the octomap.

    Attributes:
        frame: of the map; "" for the planning frame.
        resolution_m: edge of a cube.
        sensors: at least one.
    """

    frame: str
    resolution_m: float
    sensors: tuple[OctomapSensor, ...]


def octomap_settings(given: Mapping[str, Any]) -> OctomapSettings | None:
    """Return the settings among a node's parameters; None if there are no sensors.

    Raises:
        PlanningError: a value cannot be used.
    """
    names = given.get("sensors") or ()
    if isinstance(names, str) or not all(isinstance(name, str) for name in names):
        raise SettingError(f"sensors is {names!r}; it is a list of names")
    sensors = tuple(_sensor(given, name) for name in names if name)
    if not sensors:
        return None
    resolution_m = _positive(given, "octomap_resolution", RESOLUTION_M)
    return OctomapSettings(str(given.get("octomap_frame", "")), resolution_m, sensors)


def _sensor(given: Mapping[str, Any], name: str) -> OctomapSensor:
    plugin = given.get(f"{name}.sensor_plugin", "")
    if plugin != PLUGIN:
        known = describe_known(str(plugin), [PLUGIN], "there is")
        raise SettingError(f"{name}.sensor_plugin is '{plugin}'; {known}")
    topic = given.get(f"{name}.point_cloud_topic", "")
    if not topic or not isinstance(topic, str):
        raise SettingError(f"{name}.point_cloud_topic is {topic!r}; it is a topic's name")
    subsample = given.get(f"{name}.point_subsample", 1)
    if not isinstance(subsample, int) or subsample < 1:
        raise SettingError(f"{name}.point_subsample is {subsample}; it is a whole number from 1")
    return OctomapSensor(
        name,
        topic,
        _positive(given, f"{name}.max_range", 5.0),
        subsample,
        number(f"{name}.padding_offset", given.get(f"{name}.padding_offset", 0.0), least=0.0),
        _positive(given, f"{name}.padding_scale", 1.0),
        _positive(given, f"{name}.max_update_rate", 1.0),
    )


def _positive(given: Mapping[str, Any], name: str, default: float) -> float:
    return number(name, given.get(name, default), above=0.0)


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
