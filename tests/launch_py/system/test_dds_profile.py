"""The shipped Fast DDS profiles: valid, given to the Fast DDS in use, loaded without complaint."""

import os
import sys
from pathlib import Path

import pytest
from lxml import etree  # pyright: ignore[reportAttributeAccessIssue]
from run_python import run_python

from launch_py.system.dds_profile import keep_to_loopback, profile_variables, shipped_profile
from launch_py.system.packages import Packages

FOR_FAST_DDS_2 = "launch_py/config/dds_profile.xml"
FOR_FAST_DDS_3 = "launch_py/config/dds_profile_fast_dds_3.xml"
IMAGES = ("arm_gazebo/config/dds_images.xml", "arm_gazebo/config/dds_images_small.xml")
GENERAL = (FOR_FAST_DDS_2, FOR_FAST_DDS_3, *IMAGES)


def twin_of(name: str) -> str:
    return name.replace(".xml", "_localhost.xml")


def with_twins(names: tuple[str, ...]) -> tuple[str, ...]:
    return names + tuple(map(twin_of, names))


PROFILES = with_twins(GENERAL)
VARIABLE = profile_variables(os.environ)[0]
IS_FAST_DDS_3 = VARIABLE == "FASTDDS_DEFAULT_PROFILES_FILE"
IN_USE = (FOR_FAST_DDS_3 if IS_FAST_DDS_3 else FOR_FAST_DDS_2, *IMAGES)
"""Those that the Fast DDS of this environment is given; the other version's has its own schema."""
SCHEMA = "fastdds/fastdds_profiles.xsd" if IS_FAST_DDS_3 else "fastRTPS_profiles.xsd"

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
from launch_py.fast_dds.shared_memory import lock_files, lock_owners
use_local_profile(os.environ)
rclpy.init()
node = rclpy.create_node("counted")
mapped = set(re.findall("/dev/shm/fast[a-z]+_[0-9a-f]{16}", Path("/proc/self/maps").read_text()))
locks, owners = lock_files("/dev/shm"), lock_owners("/dev/shm")
names = map(os.path.basename, mapped)
found = [name for name in names if os.getpid() in owners.get(locks.get(name), ())]
node.destroy_node()
rclpy.shutdown()
print(len(found))
"""
"""Says how many shared memory segments a participant sends from: one for each such transport.

It also maps those of others in its domain from which it receives, and they may end meanwhile.
"""


def profile_path(name: str) -> Path:
    package, _, path = name.partition("/")
    return Packages(os.environ).share_folder(package) / path


def manifest(folder: Path, version: str) -> dict[str, str]:
    """Return an environment with a middleware of this version."""
    markers = folder / "share/ament_index/resource_index/packages"
    share = folder / "share/rmw_fastrtps_cpp"
    for made in (markers, share):
        made.mkdir(parents=True)
    (markers / "rmw_fastrtps_cpp").touch()
    (share / "package.xml").write_text(f"<package><version>{version}</version></package>")
    return {"AMENT_PREFIX_PATH": str(folder)}


NEW, OLD = "FASTDDS_DEFAULT_PROFILES_FILE", "FASTRTPS_DEFAULT_PROFILES_FILE"


@pytest.mark.parametrize(
    ("version", "variable", "name"),
    [("8.4.3", OLD, "dds_profile.xml"), ("9.3.3", NEW, "dds_profile_fast_dds_3.xml")],
)
def test_each_fast_dds_is_given_its_own_profile(tmp_path, version, variable, name):
    given = shipped_profile(manifest(tmp_path, version))
    assert {key: Path(value).name for key, value in given.items()} == {variable: name}


@pytest.mark.parametrize(("version", "variable"), [("8.4.3", OLD), ("9.3.3", OLD), ("9.3.3", NEW)])
def test_a_profile_of_the_users_own_is_the_only_one(tmp_path, version, variable):
    assert shipped_profile({**manifest(tmp_path, version), variable: "/mine.xml"}) == {}


def test_a_program_on_fast_dds_3_keeps_to_loopback(tmp_path):
    environ = manifest(tmp_path, "9.3.3")
    environ |= {**shipped_profile(environ), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    keep_to_loopback(environ)
    assert Path(environ[NEW]).name == "dds_profile_fast_dds_3_localhost.xml"
    assert environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "SYSTEM_DEFAULT"


@pytest.mark.parametrize("name", with_twins(IN_USE))
def test_a_profile_follows_the_schema(name):
    schema = etree.XMLSchema(etree.parse(Path(sys.prefix) / "share" / SCHEMA))
    tree = etree.parse(profile_path(name))
    # Fast DDS 2.14 reads it, but its schema does not list it.
    for controller in tree.findall(".//{*}throughputController"):
        controller.getparent().remove(controller)
    # The profiles of images serve both versions, whose schemas have namespaces of their own.
    for element in tree.iter(etree.Element) if IS_FAST_DDS_3 else ():
        element.tag = f"{{http://www.eprosima.com}}{etree.QName(element).localname}"
    assert schema.validate(tree), schema.error_log


@pytest.mark.parametrize("name", PROFILES)
def test_a_profile_makes_discovery_fast_and_wide(name):
    tree = etree.parse(profile_path(name))
    assert tree.findtext(".//{*}initialAnnouncements/{*}count") == "40"
    ranges = [e.text for e in tree.iterfind(".//{*}maxInitialPeersRange")]
    assert ranges == ["63"]


@pytest.mark.parametrize("name", PROFILES)
def test_all_peers_have_ports_in_the_last_domain(name):
    tree = etree.parse(profile_path(name))
    peers = tree.findtext(".//{*}maxInitialPeersRange")
    # The last participant's port for user data: DDSI-RTPS 2.5, 9.6.2.3.
    assert 7400 + 250 * 232 + 11 + 2 * (int(peers) - 1) <= 65535


def test_launched_processes_may_stall_for_a_while():
    tree = etree.parse(profile_path(PROFILES[0]))
    assert tree.findtext(".//{*}port_queue_capacity") == "4096"


def test_endpoint_descriptions_are_sent_in_batches():
    tree = etree.parse(profile_path(FOR_FAST_DDS_2))
    (controller,) = tree.iterfind(".//{*}throughputController")
    assert [int(text) for text in controller.itertext() if text.strip()] == [30000, 20]
    tree = etree.parse(profile_path(FOR_FAST_DDS_3))
    (controller,) = tree.iterfind(".//{*}flow_controller_descriptor")
    used = tree.findtext(".//{*}builtin/{*}flow_controller_name")
    assert [text for text in controller.itertext() if text.strip()] == [used, "FIFO", "30000", "20"]


@pytest.mark.parametrize("twin", [str, twin_of])
def test_the_two_versions_differ_in_that_alone(twin):
    trees = [etree.parse(profile_path(twin(name))) for name in (FOR_FAST_DDS_2, FOR_FAST_DDS_3)]
    for tree in trees:
        for tag in ("throughputController", "flow_controller_descriptor_list"):
            for element in tree.findall(f".//{{*}}{tag}"):
                element.getparent().remove(element)
        for element in tree.findall(".//{*}builtin/{*}flow_controller_name"):
            element.getparent().remove(element)
    assert contents(trees[0]) == contents(trees[1])


@pytest.mark.parametrize("name", PROFILES)
def test_no_participant_is_considered_dead_sooner_than_by_default(name):
    tree = etree.parse(profile_path(name))
    assert tree.find(".//{*}healthy_check_timeout_ms") is None


@pytest.mark.ros
@pytest.mark.parametrize("name", with_twins(IN_USE))
def test_a_profile_is_loaded_without_complaint(name):
    done = run_python("-c", TALK, env={**os.environ, VARIABLE: str(profile_path(name))})
    # Errors about shared memory of killed programs are allowed, errors about the profile are not.
    said = (done.stdout + done.stderr).splitlines()
    assert done.returncode == 0
    assert not [line for line in said if "RTPS_TRANSPORT_SHM" not in line]


@pytest.mark.parametrize("name", GENERAL)
def test_a_localhost_variant_is_its_profile_plus_the_meaning_of_localhost(name):
    general, twin = (etree.parse(profile_path(path)) for path in (name, twin_of(name)))
    (builtin,) = twin.iterfind(".//{*}builtin")
    (peers,) = builtin.iterfind("{*}initialPeersList")
    assert [text for text in peers.itertext() if text.strip()] == ["127.0.0.1"]
    # A locator without an address is the default one; alone, it excludes multicast.
    (own,) = builtin.iterfind("{*}metatrafficUnicastLocatorList")
    assert not [text for text in own.itertext() if text.strip()]
    (interfaces,) = twin.iterfind(".//{*}interfaceWhiteList")
    assert [text for text in interfaces.itertext() if text.strip()] == ["127.0.0.1"]
    for element in (peers, own, interfaces):
        element.getparent().remove(element)
    assert contents(twin) == contents(general)


def contents(tree) -> list[tuple[str, str]]:
    """Return the elements in their order, with their texts."""
    elements = tree.getroot().iter(etree.Element)
    return [(etree.QName(each).localname, (each.text or "").strip()) for each in elements]


@pytest.mark.ros
@pytest.mark.parametrize("name", IN_USE)
@pytest.mark.workaround("local_profile")
def test_a_process_limited_to_this_host_sends_everything_once(name):
    done = run_python(
        "-c",
        SEGMENTS,
        env={
            **os.environ,
            VARIABLE: str(profile_path(name)),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        },
        check=True,
    )
    assert done.stdout.splitlines()[-1] == "1"
