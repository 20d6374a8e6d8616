"""The parameters of the octomap."""

import pytest

from arm_description.resources import ResourceFinder
from arm_planning.configuration import move_group_parameters
from arm_planning.errors import PlanningError
from arm_planning.ros.octomap_updater import PLUGIN, octomap_settings

GIVEN = {"sensors": ["eye"], "eye.sensor_plugin": PLUGIN, "eye.point_cloud_topic": "/points"}


def test_without_sensors_there_are_no_settings():
    assert octomap_settings({}) is None
    assert octomap_settings({"sensors": [""]}) is None


def test_what_is_not_given_is_as_upstream():
    settings = octomap_settings(GIVEN)
    (sensor,) = settings.sensors
    assert (settings.frame, settings.resolution_m) == ("", 0.1)
    assert (sensor.topic, sensor.subsample, sensor.scale, sensor.padding_m) == ("/points", 1, 1, 0)


def test_those_of_the_mycobot_can_be_used():
    folder = ResourceFinder().find("package://mycobot_moveit_config/config/mycobot_280")
    nested = move_group_parameters(folder, octomap=True)
    flat = {f"camera_head.{name}": value for name, value in nested["camera_head"].items()}
    settings = octomap_settings({**nested, **flat})
    assert settings.frame == "base_link"
    assert settings.sensors[0].topic == "/camera_head/depth/color/points"
    assert "sensors" not in move_group_parameters(folder)


def test_a_configuration_without_sensors_makes_no_octomap(tmp_path):
    (tmp_path / "joint_limits.yaml").write_text("joint_limits: {}")
    with pytest.raises(PlanningError, match=r"octomap:=true needs .*sensors_3d\.yaml"):
        move_group_parameters(tmp_path, octomap=True)


@pytest.mark.parametrize(
    ("name", "value", "says"),
    [
        ("sensors", "eye", "it is a list of names"),
        ("eye.sensor_plugin", "DepthImageOctomapUpdater", "PointCloudOctomapUpdater"),
        ("eye.point_cloud_topic", "", "it is a topic's name"),
        ("eye.point_subsample", 0, "a whole number from 1"),
        ("eye.max_range", 0.0, "it is above 0"),
        ("eye.max_range", float("inf"), "not a finite number"),
        ("eye.max_update_rate", "fast", "not a finite number"),
        ("eye.padding_offset", -0.1, "at least 0"),
        ("eye.padding_scale", 0.0, "above 0"),
        ("octomap_resolution", float("nan"), "not a finite number"),
    ],
)
def test_a_value_that_cannot_be_used_is_told_why(name, value, says):
    with pytest.raises(PlanningError, match=says):
        octomap_settings({**GIVEN, name: value})
