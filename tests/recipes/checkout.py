"""A copy of the checkout that follows one recipe of CONTRIBUTING.md, and programs run in it."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "CONTRIBUTING.md"
ITEM = re.compile(r"^\d+\. `([^`]+)`", re.MULTILINE)
TIMEOUT_S = 120.0

SETUP = """\
import runpy, sys
sys.prefix = {prefix!r}  # where the suite looks for its own data files
sys.argv = {argv!r}
"""


def recipe_files(title: str) -> tuple[str, ...]:
    """Return the files that a recipe names, as it names them: `NAME` stands for the new thing."""
    _, found, after = PAGE.read_text().partition(f"\n### {title}\n")
    assert found, f"CONTRIBUTING.md has no recipe '{title}'"
    files = tuple(ITEM.findall(re.split(r"\n##", after)[0]))
    assert files, f"the recipe '{title}' names no file"
    return files


class Checkout:
    """The packages that a recipe touches, copied, with the rest of the suite as it is installed.

    Only what the recipe names can be changed, and nothing runs before all of it is.

    Args:
        folder: an empty one.
        title: of the recipe.
        words: what stands for the capital words of its paths, such as NAME="mean".
    """

    def __init__(self, folder: Path, title: str, **words: str) -> None:
        self._folder = folder
        self._left = {_filled(file, words) for file in recipe_files(title)}
        self._packages = {file.partition("/")[0] for file in self._left}
        for package in self._packages:
            shutil.copytree(
                ROOT / package,
                folder / package,
                ignore=shutil.ignore_patterns("__pycache__", "build"),
            )
            share = folder / "prefix" / "share"
            index = share / "ament_index" / "resource_index" / "packages"
            index.mkdir(parents=True, exist_ok=True)
            (index / package).touch()
            (share / package).symlink_to(folder / package)

    def write(self, file: str, text: str) -> None:
        """Write a new file."""
        path = self._taken(file)
        assert not path.exists(), f"{file} exists: the recipe changes it, and does not add it"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def insert(self, file: str, *changes: tuple[str, str]) -> None:
        """Change a file: each change is a piece of it, and the text that takes its place."""
        path = self._taken(file)
        text = path.read_text()
        for piece, new in changes:
            assert text.count(piece) == 1, f"{piece!r} occurs {text.count(piece)} times in {file}"
            text = text.replace(piece, new)
        path.write_text(text)

    def _taken(self, file: str) -> Path:
        assert file in self._left, f"the recipe names {sorted(self._left)}, but not {file}"
        self._left.remove(file)
        return self._folder / file

    def run(self, script: str, *argv: str) -> str:
        """Run a script with this checkout's code, and return what it prints."""
        done = subprocess.run(
            self.command(script, *argv),
            env=self.environment(),
            cwd=self._folder,
            capture_output=True,
            text=True,
            timeout=TIMEOUT_S,
            check=False,
        )
        assert done.returncode == 0, f"exit code {done.returncode}:\n{done.stdout}\n{done.stderr}"
        return done.stdout

    def run_module(self, module: str, *argv: str) -> str:
        """Run `python -m module` with this checkout's code, and return what it prints."""
        return self.run(f"runpy.run_module({module!r}, run_name='__main__', alter_sys=True)", *argv)

    def command(self, script: str, *argv: str) -> list[str]:
        """Return the command line that runs a script with this checkout's code."""
        assert not self._left, f"the recipe names more than was needed: {sorted(self._left)}"
        prefix = str(self._folder / "prefix")
        return [sys.executable, "-c", SETUP.format(prefix=prefix, argv=["recipe", *argv]) + script]

    def environment(self) -> dict[str, str]:
        """Return the environment in which this checkout's packages hide the installed ones."""
        folders = [str(self._folder / package) for package in sorted(self._packages)]
        before = [os.environ["PYTHONPATH"]] if "PYTHONPATH" in os.environ else []
        return {**os.environ, "PYTHONPATH": os.pathsep.join([*folders, *before])}


def _filled(file: str, words: dict[str, str]) -> str:
    for word, name in words.items():
        file = re.sub(rf"(?<![A-Z]){word}(?![A-Z])", name, file)
    return file
