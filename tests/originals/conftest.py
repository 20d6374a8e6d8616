"""The table of the originals, and a shell that types its lines."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]
for folder in (Path(__file__).parent, TESTS / "docs", TESTS.parent / "docs"):
    sys.path.insert(0, str(folder))


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Iterator[object]:
    """Carry rows out one after the other; what runs ends with the last one of the file."""
    from walk import Walk

    walk = Walk(tmp_path_factory.mktemp("reader"))
    yield walk
    walk.end()
