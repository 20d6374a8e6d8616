"""One folder, and one launch at a time, for the blocks of all pages."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder with the files that the pages print."""
    from blocks import PAGES, blocks_of

    folder = tmp_path_factory.mktemp("manual")
    for page in PAGES:
        for block in blocks_of(page):
            path = folder / block.title
            if block.title:
                same = not path.exists() or path.read_text() == block.text
                assert same, f"{block.place}: another page has another {block.title}"
                path.write_text(block.text)
    return folder


@pytest.fixture(scope="module")
def background(folder: Path) -> Iterator["object"]:
    """Keep what runs in the background; pages that start the same thing share it.

    It ends with the module: nodes of other tests have the same names, and the same domain.
    """
    from shell import Background

    background = Background(folder)
    yield background
    background.stop()
