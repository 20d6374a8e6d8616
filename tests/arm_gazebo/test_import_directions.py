"""The folders of arm_gazebo depend on each other one way, as CONTRIBUTING.md lists them."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
CODE = ROOT / "arm_gazebo" / "arm_gazebo"
FOLDERS = sorted(path.parent.name for path in CODE.glob("*/__init__.py"))
NODES = {path.stem for path in CODE.glob("*_node.py")}


def listed() -> list[str]:
    """The folders, from the top of CONTRIBUTING.md's table to its bottom."""
    _, _, table = (ROOT / "CONTRIBUTING.md").read_text().partition("folder of `arm_gazebo")
    return re.findall(r"^\| `(\w+)/` \|", table.partition("\n\n")[0], re.MULTILINE)


def imported(path: Path) -> Iterator[str]:
    """The folder, or the module beside the folders, of all that a file imports of arm_gazebo."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: a relative import"
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        else:
            continue
        yield from (name.split(".")[1] for name in names if name.startswith("arm_gazebo."))


def test_every_folder_is_listed():
    assert sorted(listed()) == FOLDERS


@pytest.mark.parametrize("folder", FOLDERS)
def test_a_folder_imports_only_from_those_below_it(folder):
    order = listed()
    above = {*order[: order.index(folder)], *NODES}
    upwards = {
        f"{path.name} imports from {name}"
        for path in (CODE / folder).glob("*.py")
        for name in imported(path)
        if name in above
    }
    assert upwards == set()


def test_the_modules_beside_the_folders_import_none_of_them():
    upwards = {
        f"{path.name} imports from {name}"
        for path in CODE.glob("*.py")
        if path.stem not in NODES
        for name in imported(path)
        if name in {*FOLDERS, *NODES}
    }
    assert upwards == set()
