"""Archives and wheel are fit for an index."""

import importlib.util
import subprocess
import sys
import tarfile
import zipfile
from email.parser import Parser

import pytest
from packaging.requirements import Requirement

# As in test_installation.
pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]


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
