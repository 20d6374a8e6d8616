"""The environment of a camera process."""

import sys
from pathlib import Path

import pytest

from arm_gazebo.camera import process as module
from arm_gazebo.camera.process import camera_environment
from arm_gazebo.sensors.camera import CameraSensor

VARIABLE = "FASTRTPS_DEFAULT_PROFILES_FILE"
LARGE = 3 << 20
"""Size in bytes of a frame that needs the large profile."""


@pytest.fixture
def shared_memory(monkeypatch):
    def free(mebibytes: int) -> None:
        monkeypatch.setattr(module, "_free_bytes", lambda _folder: mebibytes << 20)

    free(1000)
    return free


@pytest.mark.parametrize(
    ("mebibytes", "camera", "name"),
    [
        (1000, CameraSensor("a", "l", "f", 800, 800, image_topics=("image",)), "dds_images_small"),
        (1000, CameraSensor("a", "l", "f", 1280, 720, image_topics=("image",)), "dds_images"),
        (1000, CameraSensor("a", "l", "f", 640, 480, points_topics=("points",)), "dds_images"),
        (1000, CameraSensor("a", "l", "f", 640, 480, depth_topics=("depth",)), "dds_images_small"),
        (64, CameraSensor("a", "l", "f", 1280, 720, image_topics=("image",)), "dds_images_small"),
    ],
)
def test_the_profile_fits_the_frames_and_the_shared_memory(shared_memory, mebibytes, camera, name):
    shared_memory(mebibytes)
    profile = Path(camera_environment({}, camera.frame_bytes)[VARIABLE])
    assert profile.stem == name
    assert profile.is_file()


def test_a_missing_shared_memory_folder_means_none(tmp_path):
    profile = camera_environment({}, LARGE, shm=str(tmp_path / "none"))[VARIABLE]
    assert Path(profile).stem == "dds_images_small"


@pytest.mark.parametrize("variable", [VARIABLE, "FASTDDS_DEFAULT_PROFILES_FILE"])
def test_a_profile_of_the_users_own_stays(shared_memory, variable):
    environment = camera_environment({variable: "/home/me/dds.xml"}, LARGE)
    assert environment[variable] == "/home/me/dds.xml"
    assert set(environment) == {variable, "MUJOCO_GL"}


def test_the_launchers_profile_is_not_the_users_own(shared_memory):
    general = f"{sys.prefix}/share/launch_py/config/dds.xml"
    assert Path(camera_environment({VARIABLE: general}, LARGE)[VARIABLE]).stem == "dds_images"


def test_a_camera_of_a_simulation_that_keeps_to_this_host_does_so_by_its_own_profile(shared_memory):
    environment = camera_environment(
        {
            VARIABLE: f"{sys.prefix}/share/launch_py/config/dds_localhost.xml",
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT",
        },
        LARGE,
    )
    assert Path(environment[VARIABLE]).stem == "dds_images"
    assert environment["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"


@pytest.mark.parametrize("name", ["dds_images", "dds_images_small"])
def test_the_profiles_say_what_makes_discovery_quick(name):
    from lxml import etree

    text = (Path(sys.prefix) / "share/arm_gazebo/config" / f"{name}.xml").read_bytes()
    values = {e.tag.rpartition("}")[2]: e.text for e in etree.fromstring(text).iter()}
    assert values["count"] == "40"
    assert values["maxInitialPeersRange"] == "63"
    assert values["useBuiltinTransports"] == "false"
