"""Wheel, editable installation and colcon build find their data; the archives suit an index.

One file, so that one process builds the archives.
"""

import importlib.util
import subprocess
import sys
import tarfile
import zipfile
from email.parser import Parser
from pathlib import Path

import pytest
from packaging.requirements import Requirement

# An installation builds everything, on a machine that may be busy with something else.
pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]


def test_every_package_finds_its_share_folder(installation):
    wanted = {
        package: str(installation.shares(package) / package)
        for package in installation.project.packages
    }
    assert installation.description["shares"] == wanted


def test_every_module_is_the_installed_one(installation):
    for path in installation.description["modules"].values():
        assert Path(path).is_relative_to(installation.modules)


def test_every_data_file_is_there(installation):
    files = installation.project.data_files()
    missing = [
        name
        for name in files
        if not any(
            (installation.shares(package) / name).is_file()
            for package in (*installation.project.packages, *installation.project.data_packages)
        )
    ]
    assert missing == []


def test_the_robot_and_its_meshes_come_from_the_installed_data(installation):
    assert installation.description["joints"] == ["j0", "j1", "j2", "j3"]
    meshes = installation.description["meshes"]
    assert meshes
    share = installation.shares("arm_description") / "arm_description"
    assert all(Path(path).is_relative_to(share) for path in meshes.values())


def test_every_executable_is_there(installation):
    missing = [
        name for name in installation.project.scripts if not installation.executable(name).is_file()
    ]
    assert missing == []


@pytest.mark.ros
def test_an_executable_runs(installation, tmp_path):
    done = installation.run(installation.executable("publisher_terminal"), folder=tmp_path)
    # Beside it may stand what Fast DDS says of left-overs in shared memory.
    assert "Enter the 4 Joint Variables to send" in done.stdout


def test_the_wheel_holds_the_packages_and_nothing_else(wheel, project):
    with zipfile.ZipFile(wheel) as archive:
        tops = {name.split("/")[0] for name in archive.namelist()}
    stem = "-".join(wheel.name.split("-")[:2])
    assert tops == {*project.packages, f"{stem}.data", f"{stem}.dist-info"}


def test_the_wheel_has_the_executables_where_ros_2_looks_for_them(wheel, project):
    with zipfile.ZipFile(wheel) as archive:
        modes = {
            info.filename.partition(".data/data/")[2]: info.external_attr >> 16
            for info in archive.infolist()
        }
    wanted = {f"lib/{t.partition('.')[0]}/{name}" for name, t in project.scripts.items()}
    wanted.add("lib/tf2_ros/static_transform_publisher")
    assert {name for name in wanted if modes.get(name, 0) & 0o111 != 0o111} == set()


def test_twine_finds_no_fault(distributions, tmp_path):
    if importlib.util.find_spec("twine") is None:
        pytest.skip("twine comes with the extra dev")
    files = sorted(distributions.iterdir())
    assert [file.name.split("-")[0] for file in files] == [
        "arm_interfaces",
        "arm_moveit_interfaces",
        "arm_suite",
        "arm_suite",
    ]
    command = [sys.executable, "-m", "twine", "--no-color", "check", "--strict", *files]
    said = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert said.stdout.count("PASSED") == len(files), said.stdout + said.stderr


@pytest.mark.parametrize("name", ["arm_interfaces", "arm_moveit_interfaces"])
def test_an_archive_of_interfaces_holds_the_build_itself(distributions, name):
    (path,) = distributions.glob(f"{name}-*.tar.gz")
    with tarfile.open(path) as archive:
        files = {member.name.partition("/")[2] for member in archive if member.isfile()}
    assert {"setup.py", "interface_build/backend.py", "interface_build/command.py"} <= files


def test_the_interfaces_are_an_extra_of_the_wheel_and_nothing_else_needs_them(wheel):
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        metadata = Parser().parsestr(archive.read(name).decode())
    needs = [Requirement(each) for each in metadata.get_all("Requires-Dist", [])]
    extras = {each.name: str(each.marker) for each in needs if each.name.endswith("interfaces")}
    assert extras.pop("ros-jazzy-common-interfaces") == "None"
    assert extras == {
        "arm-interfaces": 'extra == "interfaces"',
        "arm-moveit-interfaces": 'extra == "planning"',
    }
