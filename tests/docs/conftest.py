"""A folder and a background for the blocks of one page, which share nothing with other pages."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return an empty folder, in which a page's commands run."""
    return tmp_path


@pytest.fixture
def background(folder: Path) -> Iterator["object"]:
    """Keep what a page runs in the background, one command at a time, until the page ends."""
    from shell import Background

    background = Background(folder)
    yield background
    background.stop()
