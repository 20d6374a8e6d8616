"""The parameters of the octomap, by MoveIt's names, as a node's parameters have them."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from arm_node.names import describe_known
from arm_planning.errors import SettingError
from arm_planning.setting_values import number

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
