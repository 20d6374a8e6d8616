"""Each folder keeps to its row of the table "must not import" in CONTRIBUTING."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROW = re.compile(r"^\| `([a-z_]+)/` \|[^|]*\| ([^|]+?) \|$", re.MULTILINE)
TABLE = (ROOT / "CONTRIBUTING.md").read_text().partition("| must not import |")[2]
RULES: dict[str, str] = dict(ROW.findall(TABLE.partition("\n\n")[0]))
SUITE = {path.name for path in ROOT.glob("*/") if (path / path.name / "__init__.py").exists()}
ARMS = {name for name in SUITE if name.startswith("arm_")}
WORDS = {"any arm_* package", "any other arm_* package", "any package of the suite", "the suite"}
NOT_EXPORTED = re.compile(r"what `(\w+)` does not export")
WITH_EXCEPTIONS = re.compile(r"any other arm_\* package, but (`\w+`(?: and `\w+`)*) in `([\w.]+)`")


def imported(folder: Path) -> Iterator[tuple[Path, str]]:
    """Yield each file with the dotted names that it imports, wherever it does."""
    for file in folder.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                yield from ((file, alias.name) for alias in node.names)
            elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
                yield file, node.module


def is_forbidden(file: Path, folder: str, rule: str, module: str) -> bool:
    package = module.partition(".")[0]
    if file.name.endswith(".launch.py") and package == "launch_py":
        return False
    exceptions = WITH_EXCEPTIONS.fullmatch(rule)
    if exceptions:
        is_excepted = f"`{package}`" in exceptions[1].split(" and ") and file.name == exceptions[2]
        return package in ARMS - {folder} and not is_excepted
    exporting = NOT_EXPORTED.fullmatch(rule)
    if exporting:
        return package == exporting[1] and module != package
    if rule in ("any arm_* package", "any other arm_* package"):
        return package in ARMS - {folder}
    if rule in ("any package of the suite", "the suite"):
        return package in SUITE
    return package in rule.split(", ")


def test_the_table_has_every_package_and_only_rules_that_this_test_knows():
    assert set(RULES) | {"arm_cli"} >= SUITE  # It may import everything.
    known = SUITE | {"mujoco"}
    for rule in RULES.values():
        patterns = (NOT_EXPORTED, WITH_EXCEPTIONS)
        is_known = rule in WORDS or any(pattern.fullmatch(rule) for pattern in patterns)
        assert is_known or set(rule.split(", ")) <= known, rule


@pytest.mark.parametrize("folder", RULES)
def test_a_folder_imports_nothing_that_its_row_forbids(folder):
    wrong = [
        f"{file.relative_to(ROOT)}: {module}"
        for file, module in imported(ROOT / folder)
        if is_forbidden(file, folder, RULES[folder], module)
    ]
    assert wrong == []
