"""What the packages import is declared, and what is declared is imported."""

import ast
import json
import sys
import tomllib
from collections.abc import Iterable
from functools import cache
from importlib.metadata import PackageNotFoundError, packages_distributions, requires
from pathlib import Path

import pytest
from declared_dependencies import DEPENDENCIES, WHEELS
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from run_python import run_python

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
INTERFACES = {"interfaces": "arm_interfaces", "planning": "arm_moveit_interfaces"}
"""The folder of the distribution that an extra names."""
WHEEL = PROJECT["tool"]["hatch"]["build"]["targets"]["wheel"]
PRODUCT = [ROOT / path for path in WHEEL["packages"]]
BESIDE = [ROOT / folder for folder in ("tests", "benchmarks", "tools", "docs", "examples")]
OF_ROS = [ROOT / "tests" / "launch_py" / "structures"]
"""Launch files of ROS 2: `arm launch` provides what they import."""
READS_MESHES = {"pycollada", "networkx"}
"""What trimesh imports for .dae and for .3mf; nothing else imports them."""
HOSTS = {"pytest"}
"""What loads a plugin of the suite; nobody imports the plugin where it is not installed."""
DECLARED = {canonicalize_name(Requirement(r).name) for r in DEPENDENCIES}
EXTRAS = PROJECT["project"]["optional-dependencies"]
OPTIONAL = {
    "arm_gazebo/arm_gazebo/batch/gpu": ["gpu"],
    "arm_planning/arm_planning/planners/ompl": ["ompl"],
    "arm_sim/arm_sim/gym": ["gym"],
    "arm_sim/arm_sim/dataset": ["dataset"],
    "arm_sim/arm_sim/sweep": ["sweep", "ray"],
}
"""Parts of the product that need extras, which no other part imports."""
PEERS = {"pytracik", "scservo_sdk", "toppra"}
"""What benchmarks compare the suite with; each script says how to install it."""
BRINGS = {"gpu": {"gymnasium"}}
"""What an extra installs for other parts of the product that need it, too."""
DISTRIBUTIONS = {"warp": "warp-lang", "griffe": "griffelib"}
"""The distributions of modules that the extra `test` does not bring, where the name differs."""
RUN = Path(__file__).with_name("run_without.py")


@cache
def imported(file: Path) -> frozenset[str]:
    found: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found.update(alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            found.add(node.module.partition(".")[0])
    return frozenset(found)


def modules_of(folders: Iterable[Path], but: Iterable[Path] = ()) -> set[str]:
    files = [
        file
        for folder in folders
        for file in folder.rglob("*.py")
        if file.stem != "setup" and not any(file.is_relative_to(part) for part in but)
    ]
    found = {name for file in files for name in imported(file)}
    return found - sys.stdlib_module_names - {package.name for package in PRODUCT}


def neighbours(folders: Iterable[Path]) -> set[str]:
    """The modules that scripts of these folders import from beside themselves."""
    files = [file for folder in folders for file in folder.rglob("*.py")]
    return {file.stem for file in files} | {file.parent.name for file in files}


@cache
def providers() -> dict[str, set[str]]:
    """The distributions that bring each top-level module."""
    found = packages_distributions().items()
    return {module: {canonicalize_name(name) for name in names} for module, names in found}


def provided_by(module: str) -> set[str]:
    # What is one compiled file is not in the list; such a distribution has its module's name.
    return providers().get(module, {canonicalize_name(DISTRIBUTIONS.get(module, module))})


def is_ros(name: str) -> bool:
    # A ROS distribution's packages come together, with the pinned ones or with a ROS installation.
    return name.startswith(("ros-", "arm-interfaces", "arm-moveit-interfaces"))


def undeclared(modules: set[str], declared: set[str]) -> set[str]:
    return {
        module
        for module in modules
        if not any(name in declared or is_ros(name) for name in provided_by(module))
    }


def closure(requirements: Iterable[str]) -> set[str]:
    """Return the distributions that these requirements install, by their metadata."""
    found: set[tuple[str, frozenset[str]]] = set()
    left = [(text, frozenset[str]()) for text in requirements]
    while left:
        text, extras = left.pop()
        requirement = Requirement(text)
        marker = requirement.marker
        if marker and not any(marker.evaluate({"extra": extra}) for extra in extras | {""}):
            continue
        one = canonicalize_name(requirement.name), frozenset(requirement.extras)
        if one not in found:
            found.add(one)
            left += [(need, one[1]) for need in needs_of(one[0])]
    return {name for name, _extras in found}


def needs_of(name: str) -> list[str]:
    try:
        return requires(name) or []
    except PackageNotFoundError:
        return []


def test_every_distribution_that_the_product_imports_is_declared():
    modules = modules_of(PRODUCT, but=[ROOT / part for part in OPTIONAL])
    assert {"rclpy", "mujoco"} < modules
    assert undeclared(modules, DECLARED | HOSTS) == set()


@pytest.mark.parametrize(("part", "needed"), OPTIONAL.items())
def test_what_an_optional_part_imports_is_in_its_extras(part, needed):
    extras = {
        canonicalize_name(Requirement(each).name) for extra in needed for each in EXTRAS[extra]
    }
    modules = modules_of([ROOT / part])
    assert undeclared(modules, DECLARED | extras) == set()
    brought = {name for extra in needed for name in BRINGS.get(extra, set())}
    assert extras - brought <= {name for module in modules for name in provided_by(module)}


def test_every_distribution_that_is_declared_is_imported():
    used = {name for module in modules_of(PRODUCT) for name in provided_by(module)}
    assert {name for name in DECLARED - used if not is_ros(name)} == READS_MESHES


def test_what_tests_tools_and_the_manual_import_is_in_an_extra():
    extras = {
        canonicalize_name(Requirement(each).name)
        for group in ("test", "docs", "dev")
        for each in EXTRAS[group]
    }
    strange = modules_of(BESIDE, but=OF_ROS) - neighbours(BESIDE) - PEERS
    assert undeclared(strange, DECLARED | extras) == set()
    assert extras & DECLARED == set()


def test_the_manual_says_what_each_dependency_is_for():
    manual = (ROOT / "docs/start/install.md").read_text()
    rows = [line.split("|")[1] for line in manual.splitlines() if line.startswith("| ")]
    named = {word.strip(" ,").partition("[")[0] for row in rows for word in row.split(",")}
    declared = {Requirement(r).name for r in DEPENDENCIES}
    assert declared - named == set()


@pytest.mark.parametrize(("extra", "folder"), INTERFACES.items())
def test_an_extra_names_the_interfaces_of_this_checkout(extra, folder):
    project = tomllib.loads((ROOT / folder / "pyproject.toml").read_text())["project"]
    assert EXTRAS[extra] == [f"{project['name']}=={project['version']}"]
    assert canonicalize_name(folder) == project["name"]


def test_the_interfaces_are_bound_to_the_same_wheels_as_the_suite():
    for folder in INTERFACES.values():
        table = tomllib.loads((ROOT / folder / "pyproject.toml").read_text())
        assert table["tool"]["interface_build"]["ros"] == WHEELS


@pytest.fixture(scope="module")
def hidden_modules() -> list[str]:
    """The modules of this environment that nobody gets who installs the suite alone."""
    installed = closure(DEPENDENCIES)
    return sorted(
        module
        for module, names in providers().items()
        if not any(name in installed or is_ros(name) or name == "arm-suite" for name in names)
    )


# A second on a quiet machine for each package, minutes on a busy one.
@pytest.mark.slow
@pytest.mark.timeout(600)
def test_all_modules_and_all_mesh_files_do_without_what_is_not_declared(hidden_modules, tmp_path):
    # Without these the test hides nothing that matters.
    assert {"scipy", "yourdfpy", "pytest"} <= set(hidden_modules)
    sys.path.insert(0, str(ROOT / "tests/fuzz"))
    try:
        from seeds import meshes
    finally:
        sys.path.remove(str(ROOT / "tests/fuzz"))
    for suffix, (mesh, *_) in meshes().items():
        (tmp_path / f"mesh{suffix}").write_bytes(mesh)
    packages = [package.name for package in PRODUCT]
    done = run_python(
        RUN, json.dumps(hidden_modules), json.dumps(packages), tmp_path, timeout_s=500.0
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == sorted(f"mesh{suffix}" for suffix in meshes())
