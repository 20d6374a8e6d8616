"""The shipped Fast DDS profiles: valid, and loaded without complaint."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]

from launch_py.system.packages import Packages

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
from arm_node.workarounds.local_profile import use_local_profile
from launch_py.fast_dds.shared_memory import lock_owners
use_local_profile(os.environ)
rclpy.init()
node = rclpy.create_node("counted")
mapped = set(re.findall("/dev/shm/fastrtps_[0-9a-f]{16}", Path("/proc/self/maps").read_text()))
owners = lock_owners("/dev/shm")
found = [path for path in mapped if os.getpid() in owners.get(os.stat(path + "_el").st_ino, ())]
node.destroy_node()
rclpy.shutdown()
print(len(found))
"""
"""Says how many shared memory segments a participant sends from: one for each such transport.

It also maps those of others in its domain from which it receives.
"""


def profile_path(name: str) -> Path:
    package, _, path = name.partition("/")
    return Packages(os.environ).share_folder(package) / path


@pytest.mark.parametrize("name", PROFILES)
def test_a_profile_follows_the_schema(name):
    schema = etree.XMLSchema(etree.parse(Path(sys.prefix) / "share" / "fastRTPS_profiles.xsd"))
    tree = etree.parse(profile_path(name))
    # Fast DDS 2.14 reads it, but its schema does not list it.
    for controller in tree.findall(".//d:throughputController", NAMESPACE):
        controller.getparent().remove(controller)
    assert schema.validate(tree), schema.error_log


@pytest.mark.parametrize("name", PROFILES)
def test_a_profile_makes_discovery_fast_and_wide(name):
    tree = etree.parse(profile_path(name))
    assert tree.findtext(".//d:initialAnnouncements/d:count", namespaces=NAMESPACE) == "40"
    ranges = [e.text for e in tree.iterfind(".//d:maxInitialPeersRange", NAMESPACE)]
    assert ranges == ["63"]


@pytest.mark.parametrize("name", PROFILES)
def test_all_peers_have_ports_in_the_last_domain(name):
    tree = etree.parse(profile_path(name))
    peers = tree.findtext(".//d:maxInitialPeersRange", namespaces=NAMESPACE)
    # The last participant's port for user data: DDSI-RTPS 2.5, 9.6.2.3.
    assert 7400 + 250 * 232 + 11 + 2 * (int(peers) - 1) <= 65535


def test_launched_processes_may_stall_for_a_while():
    tree = etree.parse(profile_path(PROFILES[0]))
    assert tree.findtext(".//d:port_queue_capacity", namespaces=NAMESPACE) == "4096"


def test_endpoint_descriptions_are_sent_in_batches():
    tree = etree.parse(profile_path(PROFILES[0]))
    (controller,) = tree.iterfind(".//d:throughputController", NAMESPACE)
    assert [int(text) for text in controller.itertext() if text.strip()] == [30000, 20]


@pytest.mark.parametrize("name", PROFILES)
def test_no_participant_is_considered_dead_sooner_than_by_default(name):
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
    # Errors about shared memory of killed programs are allowed, errors about the profile are not.
    said = (done.stdout + done.stderr).splitlines()
    assert done.returncode == 0
    assert not [line for line in said if "RTPS_TRANSPORT_SHM" not in line]


@pytest.mark.parametrize("name", GENERAL)
def test_a_localhost_variant_is_its_profile_plus_the_meaning_of_localhost(name):
    general, twin = (
        etree.parse(profile_path(path)) for path in (name, name.replace(".xml", "_localhost.xml"))
    )
    (builtin,) = twin.iterfind(".//d:builtin", NAMESPACE)
    (peers,) = builtin.iterfind("d:initialPeersList", NAMESPACE)
    assert [text for text in peers.itertext() if text.strip()] == ["127.0.0.1"]
    # A locator without an address is the default one; alone, it excludes multicast.
    (own,) = builtin.iterfind("d:metatrafficUnicastLocatorList", NAMESPACE)
    assert not [text for text in own.itertext() if text.strip()]
    (interfaces,) = twin.iterfind(".//d:interfaceWhiteList", NAMESPACE)
    assert [text for text in interfaces.itertext() if text.strip()] == ["127.0.0.1"]
    for element in (peers, own, interfaces):
        element.getparent().remove(element)
    assert contents(twin) == contents(general)


def contents(tree) -> list[tuple[str, str]]:
    """Return the elements in their order, with their texts."""
    elements = tree.getroot().iter(etree.Element)
    return [(element.tag, (element.text or "").strip()) for element in elements]


@pytest.mark.ros
@pytest.mark.parametrize("name", GENERAL)
@pytest.mark.workaround("local_profile")
def test_a_process_limited_to_this_host_sends_everything_once(name):
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
