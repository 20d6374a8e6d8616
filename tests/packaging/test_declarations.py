"""package.xml and setup.py, which colcon reads, agree with the root pyproject.toml."""

import ast
import configparser
import re
from functools import cache
from pathlib import Path

import pytest
from declared_dependencies import DEPENDENCIES
from lxml import etree
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[2]
FOLDERS = {
    path.parent.name: path.parent
    for pattern in ("*/package.xml", "robots/*/package.xml")
    for path in sorted(ROOT.glob(pattern))
}
PACKAGES = sorted(FOLDERS)
MODULE_PACKAGES = [package for package in PACKAGES if (FOLDERS[package] / package).is_dir()]
"""Those that hold more than data."""
TOOLS = {"ament_index_python", "xacro"}
"""Packages of ROS that are used without an import: the index on the disk, a program."""
ROS = {"ros-jazzy-rclpy", "ros-jazzy-common-interfaces"}
READ_BY_TRIMESH = {"pycollada", "networkx"}
PROVIDERS = {
    **{name: name for name in ("argcomplete", "glfw", "lxml", "mcap", "numpy", "rich", "segno")},
    **{name: name for name in ("trimesh", "viser", "websockets", "xacro", "xxhash", "zstandard")},
    "cv2": "opencv-python-headless",
    "mujoco": "mujoco-core",
    "re2": "google-re2",
    "serial": "pyserial",
    "yaml": "PyYAML",
}
"""The dependency of the suite that has a module."""
DATA_FOLDERS = ("config", "launch", "meshes", "scripts", "urdf", "worlds")


class SetupFile(ast.NodeVisitor):
    """The literals of a setup.py, read without running it."""

    def __init__(self, path: Path) -> None:
        self.constants: dict[str, object] = {}
        self.arguments: dict[str, object] = {}
        self.visit(ast.parse(path.read_text()))

    def visit_Assign(self, node: ast.Assign) -> None:
        if isinstance(node.targets[0], ast.Name):
            self.constants[node.targets[0].id] = self._literal(node.value)

    def visit_Call(self, node: ast.Call) -> None:
        if isinstance(node.func, ast.Name) and node.func.id == "setup":
            for keyword in node.keywords:
                self.arguments[keyword.arg or ""] = self._literal(keyword.value)
        self.generic_visit(node)

    def _literal(self, node: ast.expr) -> object:
        if isinstance(node, ast.Name):
            return self.constants.get(node.id)
        try:
            return ast.literal_eval(node)
        except ValueError:
            return None

    def entry_points(self, group: str) -> dict[str, str]:
        """One group of entry points: name to `module:object`."""
        groups = self.arguments.get("entry_points", {})
        assert isinstance(groups, dict)
        return dict(re.split(r"\s*=\s*", line) for line in groups.get(group, []))


def setup_file(package: str) -> SetupFile:
    return SetupFile(FOLDERS[package] / "setup.py")


NODE_NAMES = "launch_py.nodes"
"""The group that names nodes, not code: script name to node name."""


def manifest(package: str) -> etree._Element:
    return etree.parse(FOLDERS[package] / "package.xml").getroot()


def entry_points(table: dict) -> dict[str, dict[str, str]]:
    project = table["project"]
    return {"console_scripts": project["scripts"], **project.get("entry-points", {})}


def module_file(module: str) -> Path:
    package, _, rest = module.partition(".")
    return ROOT / package / package / (rest.replace(".", "/") + ".py")


def defined_names(module: str) -> set[str]:
    """The classes and functions of a module, found without importing it."""
    tree = ast.parse(module_file(module).read_text())
    return {node.name for node in tree.body if isinstance(node, ast.FunctionDef | ast.ClassDef)}


def leads_to_something(module: str, attribute: str) -> bool:
    """Whether there is such a package or module, or a module with such a class or function."""
    if attribute:
        return attribute in defined_names(module)
    return module in PACKAGES or module_file(module).is_file()


def test_every_package_is_in_the_wheel(project):
    wheel = project.table["tool"]["hatch"]["build"]["targets"]["wheel"]
    assert sorted(wheel["packages"]) == [f"{package}/{package}" for package in MODULE_PACKAGES]
    assert sorted(wheel["dev-mode-dirs"]) == MODULE_PACKAGES
    indexed = {target for target in wheel["shared-data"].values() if "/ament_index/" in target}
    assert {target.rpartition("/")[2] for target in indexed} == set(PACKAGES)


@pytest.mark.parametrize("package", PACKAGES)
def test_the_versions_agree(project, package):
    version = project.table["project"]["version"]
    assert manifest(package).findtext("version") == version
    assert setup_file(package).arguments["version"] == version


@pytest.mark.parametrize("package", PACKAGES)
def test_the_licences_agree(project, package):
    licence = project.table["project"]["license"]
    assert manifest(package).findtext("license") == licence
    assert setup_file(package).arguments["license"] == licence


@pytest.mark.parametrize("package", PACKAGES)
def test_the_descriptions_agree(package):
    assert setup_file(package).arguments["description"] == manifest(package).findtext("description")


@pytest.mark.parametrize("package", PACKAGES)
def test_the_names_are_the_folders(package):
    config = configparser.ConfigParser()
    config.read(FOLDERS[package] / "setup.cfg")
    assert manifest(package).findtext("name") == package
    assert setup_file(package).arguments["name"] == package
    # Where `ros2 run` looks for executables.
    assert config["install"]["install_scripts"] == f"$base/lib/{package}"
    assert config["develop"]["script_dir"] == f"$base/lib/{package}"


@pytest.mark.parametrize("package", PACKAGES)
def test_colcon_builds_it_as_a_python_package(package):
    assert manifest(package).findtext("export/build_type") == "ament_python"


@pytest.mark.parametrize("package", MODULE_PACKAGES)
def test_setuptools_finds_every_folder_of_modules(package):
    """colcon leaves out what find_packages does not see: a folder without __init__.py."""
    folders = {path.parent for path in (FOLDERS[package] / package).rglob("*.py")}
    assert [str(path) for path in folders if not (path / "__init__.py").exists()] == []


def test_no_setup_file_has_a_group_of_entry_points_that_the_root_lacks(project):
    groups = {
        group
        for package in MODULE_PACKAGES
        for group in setup_file(package).arguments.get("entry_points", {})
    }
    assert groups <= set(entry_points(project.table))


def owner(project, group: str, name: str, target: str) -> str:
    """The package whose setup.py declares an entry point: of a node's name, that of its script."""
    place = project.table["project"]["scripts"][name] if group == NODE_NAMES else target
    return place.split(".")[0]


def test_the_entry_points_agree(project):
    for group, wanted in entry_points(project.table).items():
        declared = {package: setup_file(package).entry_points(group) for package in PACKAGES}
        owned = {
            package: {
                name: target
                for name, target in wanted.items()
                if owner(project, group, name, target) == package
            }
            for package in PACKAGES
        }
        assert declared == owned, group


STAND_INS = "executable_stand_ins"


def test_every_entry_point_leads_to_something(project):
    groups = entry_points(project.table)
    assert groups.pop(NODE_NAMES).keys() <= groups["console_scripts"].keys()
    for group, targets in groups.items():
        for name, target in targets.items():
            module, _, attribute = target.partition(":")
            assert leads_to_something(module, attribute), f"{group}: {name}"


@pytest.mark.parametrize("package", PACKAGES)
def test_the_data_folders_agree(project, package):
    folder = FOLDERS[package].relative_to(ROOT)
    present = [name for name in DATA_FOLDERS if (ROOT / folder / name).is_dir()]
    assert sorted(setup_file(package).constants.get("DATA_FOLDERS", [])) == present
    wanted = {
        f"{folder}/resource/{package}": f"share/ament_index/resource_index/packages/{package}",
        f"{folder}/package.xml": f"share/{package}/package.xml",
        **{f"{folder}/{name}": f"share/{package}/{name}" for name in present},
    }
    if (ROOT / folder / "resource" / STAND_INS).is_dir():
        file = f"{STAND_INS}/{package}"
        wanted[f"{folder}/resource/{file}"] = f"share/ament_index/resource_index/{file}"
    declared = {
        source: target
        for source, target in project.shared_data.items()
        if Path(source).is_relative_to(folder)
    }
    assert declared == wanted


@pytest.mark.parametrize("package", PACKAGES)
def test_pip_finds_the_packages_that_it_needs_beside_it(package):
    """`pip install ./PACKAGE` takes them from the folders next to it."""
    folder = FOLDERS[package]
    beside = setup_file(package).constants.get("NEIGHBOURS", [])
    assert isinstance(beside, list)
    assert {(folder / path).resolve() for path in beside} == {
        FOLDERS[name] for name in declared_by(package) & set(PACKAGES)
    }


@pytest.mark.parametrize("package", PACKAGES)
def test_pip_gets_what_it_imports_and_nothing_else(project, package):
    declared = {Requirement(line).name: line for line in DEPENDENCIES}
    used = imported_in(FOLDERS[package] / package) if package in MODULE_PACKAGES else set[str]()
    wanted = {PROVIDERS[module] for module in used & PROVIDERS.keys()}
    wanted |= READ_BY_TRIMESH if "trimesh" in used else set()
    wanted |= ROS if "rclpy" in used else set()
    lines = setup_file(package).constants.get("REQUIREMENTS", [])
    assert lines == [declared[name] for name in sorted(wanted)]


def imported_in(folder: Path) -> set[str]:
    """The packages that the Python files in a folder import."""
    return {name for path in folder.rglob("*.py") for name in imported_by(path)}


@cache
def imported_by(path: Path) -> frozenset[str]:
    imported: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            imported.add(node.module.split(".")[0])
        elif isinstance(node, ast.Import):
            imported.update(alias.name.split(".")[0] for alias in node.names)
    return frozenset(imported)


def declared_by(package: str) -> set[str]:
    return {element.text or "" for element in manifest(package).iter("depend", "exec_depend")}


@pytest.mark.parametrize("package", MODULE_PACKAGES)
def test_the_other_packages_that_are_imported_are_declared(package):
    imported = imported_in(FOLDERS[package] / package)
    missing = (imported & set(PACKAGES)) - {package} - declared_by(package)
    assert missing == set()


@pytest.mark.parametrize("package", PACKAGES)
def test_what_is_declared_is_here_or_used(package):
    used = imported_in(FOLDERS[package])
    strange = declared_by(package) - set(PACKAGES) - used - TOOLS
    # What apt calls python3-yaml is imported by another name.
    assert {name for name in strange if not name.startswith("python3-")} == set()


TYPED = ("arm_control", "arm_description", "arm_gazebo", "arm_node", "arm_sim")


@pytest.mark.parametrize("package", TYPED)
def test_type_checkers_read_the_types_of_what_programs_import(package):
    assert (FOLDERS[package] / package / "py.typed").is_file()
    assert "py.typed" in setup_file(package).arguments["package_data"][package]
