"""One `arm launch mycobot planning:=true` for all files of this folder."""

import os
import sys
from collections.abc import Iterator

import pytest
from programs import Program


@pytest.fixture(scope="package")
def launched(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Program]:
    """Return the launch, ready; each file finds the arm where the one before has left it."""
    log = tmp_path_factory.mktemp("launch") / "log"
    words = [sys.executable, "-m", "arm_cli", "launch", "mycobot", "planning:=true"]
    program = Program(words, {**os.environ, "ROS_LOG_DIR": str(log)})
    program.wait_until_ready()
    yield program
    program.close()
