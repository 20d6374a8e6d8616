"""The folders of each package are layers, and no modules import each other in a circle.

`layers.toml` has the order of each package. Every import statement counts, including those under
TYPE_CHECKING and in functions, and so does `import_module("a.name")`.
"""

import ast
import tomllib
from collections.abc import Iterator, Mapping
from fnmatch import fnmatch
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
WHEEL = PROJECT["tool"]["hatch"]["build"]["targets"]["wheel"]
PACKAGES = [ROOT / path for path in WHEEL["packages"]]
ORDERS = tomllib.loads(Path(__file__).with_name("layers.toml").read_text())

Graph = Mapping[str, set[str]]


def modules_of(package: Path) -> dict[str, Path]:
    """The modules of a package by dotted name; that of a folder is its `__init__.py`."""
    modules = {}
    for file in package.rglob("*.py"):
        parts = file.relative_to(package.parent).with_suffix("").parts
        modules[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = file
    return modules


def imports(module: str, file: Path, known: set[str]) -> Iterator[str]:
    """The modules of the product that a module's import statements name."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in known)
        elif isinstance(node, ast.ImportFrom):
            home = node.module or ""
            if node.level:
                parts = [*module.split("."), "x"] if file.stem == "__init__" else module.split(".")
                home = ".".join([*parts[: -node.level], *filter(None, [home])])
            for alias in node.names:
                inner = f"{home}.{alias.name}"
                if inner in known or home in known:
                    yield inner if inner in known else home
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith("import_module"):
            values = (word.value for word in node.args if isinstance(word, ast.Constant))
            yield from (value for value in values if value in known)


@cache
def graph() -> Graph:
    """Who imports whom in the product."""
    files = {name: file for package in PACKAGES for name, file in modules_of(package).items()}
    known = set(files)
    return {name: set(imports(name, file, known)) - {name} for name, file in files.items()}


def in_circles(graph: Graph) -> list[set[str]]:
    """The groups of modules that reach each other (strongly connected components, by Tarjan)."""
    index: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    groups: list[set[str]] = []

    def visit(node: str) -> None:
        index[node] = low[node] = len(index)
        stack.append(node)
        for other in sorted(graph.get(node, ())):
            if other not in index:
                visit(other)
            if other in stack:
                low[node] = min(low[node], low[other])
        if low[node] == index[node]:
            group = set(stack[stack.index(node) :])
            del stack[stack.index(node) :]
            if len(group) > 1:
                groups.append(group)

    for node in sorted(graph):
        if node not in index:
            visit(node)
    return groups


def place_of(room: str, order: list[str], folders: set[str]) -> int | None:
    """The place of a room or module of a package in its order; None if the order lacks it."""
    if room in order:
        return order.index(room)
    patterns = [] if room in folders else [each for each in order if "*" in each]
    fitting = (each for each in sorted(patterns, key=len, reverse=True) if fnmatch(room, each))
    found = next(fitting, None)
    return None if found is None else order.index(found)


def broken_order(order: list[str], imports: Graph) -> list[str]:
    """One line for each import that goes up, and for each module that has no place."""
    parts = {module: module.split(".") for module in imports}
    folders = {part[1] for part in parts.values() if len(part) > 2}
    rooms = {module: part[1] if len(part) > 1 else "__init__" for module, part in parts.items()}
    for module, part in parts.items():
        if len(part) == 2 and f"{part[1]}.__init__" in order:
            rooms[module] = f"{part[1]}.__init__"
    places = {room: place_of(room, order, folders) for room in set(rooms.values())}
    lines = []
    for module, others in sorted(imports.items()):
        place = places[rooms[module]]
        if place is None:
            lines.append(f"{module} has no place in the order")
            continue
        for other in sorted(others):
            its = places[rooms[other]]
            if its is not None and its < place:
                lines.append(f"{module} ({order[place]}) imports {other} ({order[its]} is above)")
    return lines


def test_every_package_has_an_order():
    assert ORDERS.keys() == {path.name for path in PACKAGES}


@pytest.mark.parametrize("package", sorted(ORDERS))
def test_rooms_import_only_from_rooms_below(package):
    own = {
        module: {other for other in others if other.partition(".")[0] == package}
        for module, others in graph().items()
        if module.partition(".")[0] == package
    }
    assert own, f"no modules of {package}"
    broken = broken_order(ORDERS[package], own)
    assert not broken, "\n".join(broken)


@pytest.mark.parametrize("package", sorted(ORDERS))
def test_orders_name_what_exists(package):
    folder = next(path for path in PACKAGES if path.name == package)
    names = {path.stem for path in folder.iterdir()}
    rooms = {each.removesuffix(".__init__") for each in ORDERS[package] if "*" not in each}
    assert rooms <= names


def test_no_modules_import_each_other_in_a_circle():
    circles = [sorted(group) for group in in_circles(graph())]
    assert not circles, "\n".join(", ".join(each) for each in circles)


def test_a_circle_is_found_whatever_leads_into_it():
    assert in_circles({"top": {"a"}, "a": {"b"}, "b": {"c"}, "c": {"a", "low"}, "low": set()}) == [
        {"a", "b", "c"}
    ]


def test_imports_for_types_and_within_functions_count(tmp_path):
    file = tmp_path / "reader.py"
    file.write_text(
        "from typing import TYPE_CHECKING\n"
        "if TYPE_CHECKING:\n    from robot.parts import Gripper\n"
        "def read():\n    from robot import arm\n    import robot.base\n"
        "    return importlib.import_module('robot.tool').Tool\n"
    )
    parts = {"robot.parts", "robot.arm", "robot.base", "robot.tool"}
    assert set(imports("reader", file, {"robot", *parts})) == parts


def test_an_import_that_goes_up_is_told():
    imports = {
        "p": set(),
        "p.a.x": {"p.b.x"},
        "p.b.x": {"p.low"},
        "p.low": {"p.a.x"},
        "p.c.x": set(),
    }
    assert broken_order(["__init__", "a", "b", "*"], imports) == [
        "p.c.x has no place in the order",
        "p.low (*) imports p.a.x (a is above)",
    ]


def test_a_folder_may_show_names_from_above_it():
    imports = {"p": set(), "p.a": {"p.a.x", "p.b"}, "p.a.x": set(), "p.b": {"p.a.x"}}
    assert broken_order(["__init__", "a.__init__", "b", "a"], imports) == []
    assert broken_order(["__init__", "b", "a"], imports) == ["p.a (a) imports p.b (b is above)"]
