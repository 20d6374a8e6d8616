"""What the packages import is declared, not brought along by luck by something else."""

import ast
import re
import sys
import tomllib
from collections.abc import Iterator
from importlib.metadata import packages_distributions
from pathlib import Path

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
WHEEL = PROJECT["tool"]["hatch"]["build"]["targets"]["wheel"]
PACKAGES = [ROOT / path for path in WHEEL["packages"]]


def distribution(requirement: str) -> str:
    return re.sub(r"[-_.]+", "-", re.split(r"[\[<>=~! ]", requirement)[0]).lower()


def imported(file: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield node.module.partition(".")[0]


def test_every_distribution_that_is_imported_is_declared():
    modules = {name for package in PACKAGES for f in package.rglob("*.py") for name in imported(f)}
    modules -= sys.stdlib_module_names | {package.name for package in PACKAGES}
    providers = packages_distributions()
    declared = {distribution(each) for each in PROJECT["project"]["dependencies"]}
    missing = {
        module
        for module in modules
        if not any(is_declared(name, declared) for name in providers.get(module, []))
    }
    assert {"rclpy", "mujoco"} < modules
    assert missing == set()


def is_declared(name: str, declared: set[str]) -> bool:
    # A ROS distribution's packages come together, with the pinned ones or with a ROS installation.
    return distribution(name) in declared or name.startswith(("ros-", "arm-interfaces"))
