"""The shipped Fast DDS profiles: valid, and loaded without complaint."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]

from launch_py.packages import Packages

GENERAL = (
    "launch_py/config/dds_profile.xml",
    "arm_gazebo/config/dds_images.xml",
    "arm_gazebo/config/dds_images_small.xml",
)
TWINS = tuple(name.replace(".xml", "_localhost.xml") for name in GENERAL)
PROFILES = GENERAL + TWINS
NAMESPACE = {"d": "http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles"}

TALK = """
import rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("profiled")
received = []
publisher = node.create_publisher(String, "chat", 1)
node.create_subscription(String, "chat", received.append, 1)
while not received:
    publisher.publish(String(data="x"))
    rclpy.spin_once(node, timeout_sec=0.02)
node.destroy_node()
rclpy.shutdown()
"""


SEGMENTS = """
import os, re, rclpy
from pathlib import Path
from arm_node.local_profile import use_local_profile
use_local_profile(os.environ)
rclpy.init()
node = rclpy.create_node("counted")
found = set(re.findall("/dev/shm/fastrtps_[0-9a-f]{16}", Path("/proc/self/maps").read_text()))
node.destroy_node()
rclpy.shutdown()
print(len(found))
"""
"""Says how many shared memory segments a participant sends from: one for each such transport."""


def profile_path(name: str) -> Path:
    package, _, path = name.partition("/")
    return Packages(os.environ).share_folder(package) / path


@pytest.mark.parametrize("name", PROFILES)
def test_a_profile_follows_the_schema(name):
    schema = etree.XMLSchema(etree.parse(Path(sys.prefix) / "share" / "fastRTPS_profiles.xsd"))
    tree = etree.parse(profile_path(name))
    # Fast DDS 2.14 reads it, its schema does not list it.
    for controller in tree.findall(".//d:throughputController", NAMESPACE):
        controller.getparent().remove(controller)
    assert schema.validate(tree), schema.error_log


@pytest.mark.parametrize("name", PROFILES)
def test_a_profile_makes_discovery_fast_and_wide(name):
    tree = etree.parse(profile_path(name))
    assert tree.findtext(".//d:initialAnnouncements/d:count", namespaces=NAMESPACE) == "40"
    ranges = [e.text for e in tree.iterfind(".//d:maxInitialPeersRange", NAMESPACE)]
    assert ranges == ["64"]


def test_launched_processes_may_be_held_up_for_a_while():
    tree = etree.parse(profile_path(PROFILES[0]))
    assert tree.findtext(".//d:port_queue_capacity", namespaces=NAMESPACE) == "4096"


def test_descriptions_of_end_points_are_sent_some_together():
    tree = etree.parse(profile_path(PROFILES[0]))
    (controller,) = tree.iterfind(".//d:throughputController", NAMESPACE)
    assert [int(text) for text in controller.itertext() if text.strip()] == [30000, 20]


@pytest.mark.parametrize("name", PROFILES)
def test_nobody_is_taken_for_dead_sooner_than_by_default(name):
    tree = etree.parse(profile_path(name))
    assert tree.find(".//d:healthy_check_timeout_ms", NAMESPACE) is None


@pytest.mark.ros
@pytest.mark.parametrize("name", PROFILES)
def test_a_profile_is_loaded_without_complaint(name):
    done = subprocess.run(
        [sys.executable, "-c", TALK],
        env={**os.environ, "FASTRTPS_DEFAULT_PROFILES_FILE": str(profile_path(name))},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    # Of shared memory of other programs, which may have been killed; no word on the profile.
    said = (done.stdout + done.stderr).splitlines()
    assert done.returncode == 0
    assert not [line for line in said if "RTPS_TRANSPORT_SHM" not in line]


@pytest.mark.parametrize("name", GENERAL)
def test_a_twin_is_its_profile_and_what_localhost_means(name):
    general, twin = (
        etree.parse(profile_path(path)) for path in (name, name.replace(".xml", "_localhost.xml"))
    )
    (builtin,) = twin.iterfind(".//d:builtin", NAMESPACE)
    (peers,) = builtin.iterfind("d:initialPeersList", NAMESPACE)
    assert [text for text in peers.itertext() if text.strip()] == ["127.0.0.1"]
    # A locator without address: the default one, but alone, so that there is none for multicast.
    (own,) = builtin.iterfind("d:metatrafficUnicastLocatorList", NAMESPACE)
    assert not [text for text in own.itertext() if text.strip()]
    builtin.remove(peers)
    builtin.remove(own)
    assert contents(twin) == contents(general)


def contents(tree) -> list[tuple[str, str]]:
    """Return the elements in their order, with their texts."""
    elements = tree.getroot().iter(etree.Element)
    return [(element.tag, (element.text or "").strip()) for element in elements]


@pytest.mark.ros
@pytest.mark.parametrize("name", GENERAL)
def test_a_process_that_keeps_to_this_host_sends_everything_once(name):
    done = subprocess.run(
        [sys.executable, "-c", SEGMENTS],
        env={
            **os.environ,
            "FASTRTPS_DEFAULT_PROFILES_FILE": str(profile_path(name)),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        },
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    assert done.stdout.splitlines()[-1] == "1"
