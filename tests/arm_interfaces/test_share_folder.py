"""Recorders and command line tools find the definitions by the ament index."""

import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from ament_index_python.packages import get_package_share_directory
from ament_index_python.resources import get_resource

PACKAGES = [
    "tf2_msgs",
    "control_msgs",
    "controller_manager_msgs",
    "composition_interfaces",
    "pal_statistics_msgs",
    "simulation_interfaces",
    "moveit_msgs",
    "object_recognition_msgs",
    "octomap_msgs",
]


@pytest.fixture(autouse=True)
def _prefix_path(monkeypatch) -> None:
    monkeypatch.setenv("AMENT_PREFIX_PATH", sys.prefix)


@pytest.mark.parametrize("package", PACKAGES)
def test_definitions_are_those_of_the_record(package, expected_types):
    share = Path(get_package_share_directory(package))
    found = {path.relative_to(share).as_posix() for path in share.glob("*/*")}
    names = [name.split("/")[1:] for name in expected_types if name.startswith(f"{package}/")]
    assert found == {f"{kind}/{name}.{kind}" for kind, name in names}


@pytest.mark.parametrize("package", PACKAGES)
def test_index_lists_the_definitions(package):
    listed, prefix = get_resource("rosidl_interfaces", package)
    share = Path(prefix) / "share" / package
    assert listed.splitlines()
    assert all((share / line).is_file() for line in listed.splitlines())


@pytest.mark.parametrize("package", PACKAGES)
def test_manifest_names_the_package(package):
    manifest = Path(get_package_share_directory(package)) / "package.xml"
    root = ElementTree.parse(manifest).getroot()
    assert root.findtext("name") == package
    assert root.findtext("member_of_group") == "rosidl_interface_packages"


@pytest.mark.parametrize("package", PACKAGES)
def test_manifest_names_every_package_that_a_definition_uses(package):
    share = Path(get_package_share_directory(package))
    root = ElementTree.parse(share / "package.xml").getroot()
    text = "".join(path.read_text(encoding="utf-8") for path in share.glob("*/*"))
    used = {line.split("/")[0] for line in text.splitlines() if "/" in line.split("#")[0]}
    has_actions = any(share.glob("action/*"))
    wanted = (used - {package, ""}) | ({"action_msgs"} if has_actions else set())
    assert {depend.text for depend in root.iter("depend")} == wanted
