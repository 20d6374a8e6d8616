"""Each folder's setup.py gives setuptools the modules and data files that the suite's wheel has."""

import runpy
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
FOLDERS = sorted(
    path.parent for folder in (ROOT, ROOT / "robots") for path in folder.glob("*/package.xml")
)


@pytest.fixture(params=FOLDERS, ids=lambda folder: folder.name)
def folder(request) -> Path:
    """Return the folder of a package."""
    return request.param


@pytest.fixture
def given(folder, monkeypatch) -> dict[str, Any]:
    """Return what setup.py gives to setuptools."""
    words: dict[str, Any] = {}
    monkeypatch.chdir(folder)
    monkeypatch.setattr("setuptools.setup", lambda **given: words.update(given))
    runpy.run_path("setup.py")
    return words


def test_the_data_files_are_those_of_the_wheel(folder, given, project):
    installed = {
        f"{place}/{file.rpartition('/')[2]}"
        for place, files in given["data_files"]
        for file in files
    }
    wanted = replace(project, only=frozenset([folder.name])).data_files()
    assert installed == {f"share/{name}" for name in wanted}


def test_the_modules_are_all_there(folder, given):
    modules = (path.relative_to(folder) for path in (folder / folder.name).rglob("*.py"))
    assert set(given["packages"]) == {".".join(path.parent.parts) for path in modules}
