"""What the page takes from an RViz configuration, and what it saves."""

import math
import os

import pytest
import yaml

from arm_description.resources import resolve_uri
from arm_description.view_fitting import View
from arm_viewer.errors import ConfigError
from arm_viewer.rviz_config import SWITCHES, PageConfig, read_config, read_config_file, write_config


def test_the_arm_s_configuration_shows_links_frames_and_its_orbit():
    path = resolve_uri("package://arm_description/config/rviz/arm.rviz")
    config = read_config(path.read_bytes(), path.name)
    assert {switch for switch, is_shown in config.shown.items() if is_shown} == {"visual", "frames"}
    assert config.fixed_frame == "world"
    assert config.remark == ""
    assert config.view is not None
    assert config.view.target == (0.0, 0.0, 0.2)
    assert math.dist(config.view.position, config.view.target) == pytest.approx(1.0)
    assert config.view.position[2] == pytest.approx(0.2 + math.sin(0.35))


@pytest.mark.parametrize("switch", SWITCHES)
def test_what_is_saved_is_read_again(switch):
    shown = {key: key == switch for key in SWITCHES}
    view = View((1.0, -2.0, 0.5), (0.25, 0.0, 0.125))
    read = read_config(write_config(PageConfig(shown, view, "odom")), "page.rviz")
    assert read.shown == shown
    assert read.fixed_frame == "odom"
    assert read.remark == ""
    assert read.view is not None
    assert read.view.target == view.target
    assert read.view.position == pytest.approx(view.position)


def test_what_the_page_does_not_have_is_one_sentence():
    manager = {
        "Displays": [{"Class": "rviz_default_plugins/Map", "Enabled": True}],
        "Views": {"Current": {"Class": "rviz_default_plugins/FPS"}},
    }
    config = read_config(yaml.safe_dump({"Visualization Manager": manager}).encode(), "lab.rviz")
    assert config.remark == (
        "The page does not have rviz_default_plugins/Map, rviz_default_plugins/FPS of lab.rviz."
    )
    assert config.view is None
    assert not any(config.shown.values())
    assert "world" not in config.shown


def test_a_file_that_is_not_there_is_refused_by_its_path(tmp_path):
    with pytest.raises(ConfigError, match=r"cannot read .*lab\.rviz: No such file"):
        read_config_file(str(tmp_path / "lab.rviz"))


def test_a_fifo_is_refused(tmp_path):
    os.mkfifo(tmp_path / "lab.rviz")
    with pytest.raises(ConfigError, match=r"cannot read .*lab\.rviz: it is a FIFO"):
        read_config_file(str(tmp_path / "lab.rviz"))


@pytest.mark.parametrize(
    "content", [b"", b"\xff\xfe", b"a: [", b"- 1", b"Visualization Manager: 3", b"[" * 65]
)
def test_other_files_are_refused_by_name(content):
    with pytest.raises(ConfigError, match=r"lab\.rviz is not an RViz configuration"):
        read_config(content, "lab.rviz")


@pytest.mark.parametrize("distance", [f"1{'0' * 400}", ".nan", "far", "-1.0"])
def test_a_view_from_nowhere_is_remarked(distance):
    text = (
        "Visualization Manager: {Displays: [], Views: {Current: "
        f"{{Class: rviz_default_plugins/Orbit, Distance: {distance}}}}}}}"
    )
    config = read_config(text.encode(), "lab.rviz")
    assert config.view is None
    assert "rviz_default_plugins/Orbit" in config.remark
