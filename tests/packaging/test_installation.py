"""Wheel, editable installation and colcon build all find their data, from any folder."""

import zipfile
from pathlib import Path

import pytest

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
            for package in (
                *installation.project.packages,
                *installation.project.data_packages,
            )
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
