"""Print how many files, lines, classes and long functions the product has.

    python tools/house_numbers.py        # the numbers
    python tools/house_numbers.py -v     # and what stands behind each of them

The product is what the wheel installs. Blank lines and comments count as lines.
"""

import argparse
import ast
import sys
import tomllib
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SHORT_FILE = 40
LONG_FILE = 400
LONG_FUNCTION = 60


@dataclass(frozen=True)
class Module:
    """A file of the product."""

    name: str
    file: Path

    @cached_property
    def text(self) -> str:
        """The file's text."""
        return self.file.read_text(encoding="utf-8")

    @cached_property
    def tree(self) -> ast.Module:
        """The file's syntax tree."""
        return ast.parse(self.text, str(self.file))

    @property
    def lines(self) -> int:
        """How many lines the file has."""
        return len(self.text.splitlines())

    @property
    def is_package(self) -> bool:
        """Whether the file is the `__init__.py` of a folder."""
        return self.file.name == "__init__.py"

    def classes(self) -> list[str]:
        """Return the names of the public classes that the module itself defines."""
        definitions = (node for node in self.tree.body if isinstance(node, ast.ClassDef))
        return [node.name for node in definitions if not node.name.startswith("_")]

    def long_functions(self) -> Iterator[tuple[str, int]]:
        """Return the functions of more than 60 lines, decorators not counted."""
        for node in ast.walk(self.tree):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                length = (node.end_lineno or node.lineno) - node.lineno + 1
                if length > LONG_FUNCTION:
                    yield node.name, length

    def imported(self, known: Mapping[str, "Module"]) -> set[str]:
        """Return the modules among `known` that this one imports, wherever in its text."""
        found: set[str] = set()
        for node in ast.walk(self.tree):
            if isinstance(node, ast.Import):
                found.update(alias.name for alias in node.names)
            elif isinstance(node, ast.ImportFrom):
                home = self._home(node)
                found.add(home)
                found.update(f"{home}.{alias.name}" for alias in node.names)
        return {name for name in found if name in known} - {self.name}

    def _home(self, node: ast.ImportFrom) -> str:
        if not node.level:
            return node.module or ""
        parts = self.name.split(".")
        kept = len(parts) - node.level + self.is_package
        return ".".join([*parts[:kept], *filter(None, [node.module])])


def product(packages: Iterable[Path]) -> dict[str, Module]:
    """Return the modules below these folders of packages by their dotted names."""
    modules: dict[str, Module] = {}
    for package in packages:
        for file in sorted(package.rglob("*.py")):
            parts = file.relative_to(package.parent).with_suffix("").parts
            name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
            modules[name] = Module(name, file)
    return modules


def installed_packages() -> list[Path]:
    """Return the folders of Python packages that the wheel of the suite installs."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    wheel = project["tool"]["hatch"]["build"]["targets"]["wheel"]
    return [ROOT / path for path in wheel["packages"]]


def numbers(modules: Mapping[str, Module]) -> dict[str, Sequence[str] | int]:
    """Return each number by what it counts: a list of what is counted, or the sum alone.

    A package's `__init__.py` is a file with lines; it is not counted among the short files nor
    among those with a single user, because it says what a folder shows, and nothing else.
    """
    ordinary = [module for module in modules.values() if not module.is_package]
    users: dict[str, set[str]] = defaultdict(set)
    for module in modules.values():
        for name in module.imported(modules):
            users[name].add(module.name)
    classes = [(name, module.name) for module in modules.values() for name in module.classes()]
    times = Counter(name for name, _ in classes)
    return {
        "product files": len(modules),
        "product lines": sum(module.lines for module in modules.values()),
        f"files under {SHORT_FILE} lines": [
            f"{module.name} ({module.lines})" for module in ordinary if module.lines < SHORT_FILE
        ],
        f"files over {LONG_FILE} lines": [
            f"{module.name} ({module.lines})"
            for module in modules.values()
            if module.lines > LONG_FILE
        ],
        f"functions over {LONG_FUNCTION} lines": [
            f"{module.name}.{name} ({length})"
            for module in modules.values()
            for name, length in module.long_functions()
        ],
        "public classes": len(classes),
        "class names that stand twice": [
            f"{name}: {', '.join(sorted(home for each, home in classes if each == name))}"
            for name, count in sorted(times.items())
            if count > 1
        ],
        "modules imported by a single other module": [
            f"{module.name} by {next(iter(users[module.name]))}"
            for module in ordinary
            if len(users[module.name]) == 1
        ],
    }


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the numbers; return 0."""
    parser = argparse.ArgumentParser(
        description="Print how many files, lines, classes and long functions the product has."
    )
    parser.add_argument("-v", "--verbose", action="store_true", help="list what is counted")
    parser.add_argument("folders", nargs="*", type=Path, help="packages (the suite's own)")
    options = parser.parse_args(arguments)
    modules = product(options.folders or installed_packages())
    for what, counted in numbers(modules).items():
        count = counted if isinstance(counted, int) else len(counted)
        sys.stdout.write(f"{count:>7,}  {what}\n")
        if options.verbose and not isinstance(counted, int):
            sys.stdout.writelines(f"{'':9}{line}\n" for line in counted)
    return 0


if __name__ == "__main__":
    sys.exit(main())
