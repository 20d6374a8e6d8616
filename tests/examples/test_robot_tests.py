"""The template repository: its tests pass, and its CI files say what its README says."""

import os
import re
import shutil
from pathlib import Path

import pytest
import yaml
from run_python import run_python

TEMPLATE = Path(__file__).parents[2] / "examples" / "robot_tests"
INSTALL, RUN = re.findall(r"^    (.+)$", (TEMPLATE / "README.md").read_text(), re.MULTILINE)
TIMEOUT_S = 500.0


@pytest.fixture
def copied(tmp_path) -> Path:
    """The folder as a user has it after copying it."""
    target = tmp_path / "patrol"
    shutil.copytree(TEMPLATE, target)
    return target


def run_tests(folder: Path, file: str) -> str:
    environment = {k: v for k, v in os.environ.items() if not k.startswith("PYTEST_")}
    done = run_python(
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        file,
        env={**environment, "PYTHONPATH": str(folder)},
        cwd=folder,
        timeout_s=TIMEOUT_S,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_its_decisions_pass_their_tests(copied):
    assert re.search(r"\b5 passed", run_tests(copied, "tests/test_motion.py"))
    assert not (copied / "arm-artifacts").exists()


@pytest.mark.ros
@pytest.mark.slow
@pytest.mark.timeout(600)
def test_its_node_passes_its_tests(copied):
    assert re.search(r"\b3 passed", run_tests(copied, "tests/test_node.py"))


def test_github_runs_what_the_readme_says():
    text = (TEMPLATE / ".github" / "workflows" / "tests.yml").read_text()
    steps = yaml.safe_load(text)["jobs"]["tests"]["steps"]
    commands = [step["run"] for step in steps if "run" in step]
    assert commands == [INSTALL, f"{RUN} --junitxml=report.xml"]


def test_gitlab_runs_what_the_readme_says():
    job = yaml.safe_load((TEMPLATE / ".gitlab-ci.yml").read_text())["tests"]
    assert job["script"] == [INSTALL, f"{RUN} --junitxml=report.xml"]
