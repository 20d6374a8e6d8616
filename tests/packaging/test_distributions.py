"""Archives and wheel are fit for an index."""

import importlib.util
import subprocess
import sys
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
        "arm_suite",
        "arm_suite",
    ]
    command = [sys.executable, "-m", "twine", "--no-color", "check", "--strict", *files]
    said = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert said.stdout.count("PASSED") == len(files), said.stdout + said.stderr


def test_the_interfaces_are_an_extra_of_the_wheel_and_nothing_else_needs_them(wheel):
    with zipfile.ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        metadata = Parser().parsestr(archive.read(name).decode())
    needs = [Requirement(each) for each in metadata.get_all("Requires-Dist", [])]
    (interfaces,) = (each for each in needs if each.name == "arm-interfaces")
    assert str(interfaces.marker) == 'extra == "interfaces"'
