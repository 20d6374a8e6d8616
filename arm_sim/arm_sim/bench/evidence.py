"""Explains the failure of a test: writes files into a folder, and adds lines to its report."""

import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from arm_gazebo.errors import GazeboError

if TYPE_CHECKING:
    import pytest

SECTION = "arm"
GITIGNORE = "*\n"
MAX_NAME = 120


class Evidence(Protocol):
    """A fixture's value that can explain a failure."""

    def report(self, folder: Path) -> Iterator[str]:
        """Write files into a folder, and yield lines; may raise OSError or GazeboError."""
        ...


def explain(
    item: "pytest.Item", report: "pytest.TestReport", folder: Path, value: Evidence
) -> None:
    """Add a fixture's evidence to the report of a failed test.

    Args:
        item: the test.
        report: its report.
        folder: where the files of all tests go.
        value: the fixture's value.
    """
    lines: list[str] = []
    try:
        mine = _folder_of(item, folder)
        lines.extend(value.report(mine))
    except (OSError, GazeboError) as error:
        lines.append(f"the report cannot be written: {error}")
    else:
        # JUnit XML takes the properties from a later report, at the end of the test.
        item.user_properties.append((SECTION, str(mine)))
    report.sections.append((SECTION, "\n".join(lines)))


def _folder_of(item: "pytest.Item", folder: Path) -> Path:
    """Return an empty folder for a test."""
    folder.mkdir(parents=True, exist_ok=True)
    # As in pytest's own cache: nobody should commit the files by mistake.
    (folder / ".gitignore").write_text(GITIGNORE, encoding="utf-8")
    name = re.sub(r"[^\w.-]+", "-", item.nodeid).strip("-")[-MAX_NAME:]
    mine = folder / name
    shutil.rmtree(mine, ignore_errors=True)
    mine.mkdir(parents=True)
    return mine
