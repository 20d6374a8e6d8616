"""The parts of the build that can be tried without building."""

import functools
import importlib
import io
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
DISTRIBUTIONS = [ROOT / "arm_interfaces", ROOT / "arm_moveit_interfaces"]


def output_of(code: str, folder: Path | None = None) -> str:
    """Return what Python code prints in a process of its own, in a folder."""
    command = [sys.executable, "-B", "-c", code]
    return subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True).stdout


@pytest.fixture
def build_module(monkeypatch):
    """Import a module of the build, which is never installed."""
    monkeypatch.syspath_prepend(str(DISTRIBUTIONS[0]))
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def load(name: str) -> ModuleType:
        return importlib.import_module(f"interface_build.{name}")

    return load


@pytest.fixture(params=DISTRIBUTIONS, ids=lambda folder: folder.name)
def distribution(request) -> Path:
    """A distribution of interface packages."""
    return request.param


@pytest.fixture
def packages(build_module, distribution):
    """The packages of a distribution."""
    return build_module("interface_package").find_packages(distribution / "interfaces")


def test_source_tree_holds_the_recorded_types(build_module, expected_types):
    find_packages = build_module("interface_package").find_packages
    found = {
        f"{package.name}/{interface.kind}/{interface.name}"
        for distribution in DISTRIBUTIONS
        for package in find_packages(distribution / "interfaces")
        for interface in package.interfaces
    }
    assert found == set(expected_types)


def test_a_package_knows_those_of_its_distribution_that_it_uses(build_module):
    found = build_module("interface_package").find_packages(DISTRIBUTIONS[1] / "interfaces")
    uses = {package.name: set(package.uses) for package in found}
    assert uses["moveit_msgs"] == {"object_recognition_msgs", "octomap_msgs"}
    assert uses["octomap_msgs"] == set()


def test_every_distribution_is_built_by_the_same_code_under_its_own_name(distribution):
    code = "from interface_build.project import *; print(DEFINITIONS, read_project().name)"
    found = output_of(code, distribution)
    assert found.split() == [str(distribution / "interfaces"), distribution.name]
    backend = distribution / "interface_build" / "backend.py"
    assert backend.samefile(DISTRIBUTIONS[0] / "interface_build" / "backend.py")


@pytest.mark.parametrize(
    ("chosen", "wheel"), [("", "ros-jazzy-"), ("jazzy", "ros-jazzy-"), ("kilted", "ros-kilted-")]
)
def test_ros_distro_chooses_the_wheels(build_module, monkeypatch, chosen, wheel):
    monkeypatch.setenv("ROS_DISTRO", chosen)
    read_project = build_module("project").read_project
    read_project.cache_clear()
    wheels = [name for name in read_project().dependencies if name.startswith("ros-")]
    assert len(wheels) == 2
    assert all(name.startswith(wheel) for name in wheels)


def test_a_distribution_without_wheels_is_refused_in_a_sentence(build_module, monkeypatch):
    monkeypatch.setenv("ROS_DISTRO", "kilt")
    read_project = build_module("project").read_project
    read_project.cache_clear()
    with pytest.raises(SystemExit, match=r"ROS_DISTRO is 'kilt', but .* for jazzy or kilted only"):
        read_project()


class RecordedBuild:
    """A build whose steps write their names to a file."""

    def __init__(self, package_build: Any, file: Path, package: str, uses: str = "") -> None:
        self.stage, self.step = package_build.Stage, package_build.BuildStep
        self.file, self.package, self.uses = file, package, uses

    def stages(self) -> list[Any]:
        """Return two stages; the first follows that of another package."""
        first, second = (self.package, "first"), (self.package, "second")
        after = frozenset({(self.uses, "first")} if self.uses else ())
        return [
            self.stage(first, (self._step("first"),), after),
            self.stage(second, (self._step("a"), self._step("b")), frozenset({first})),
        ]

    def _step(self, name: str) -> Any:
        return self.step(name, functools.partial(self._write, f"{self.package} {name}\n"))

    def _write(self, line: str) -> None:
        with self.file.open("a") as file:
            file.write(line)


def test_a_stage_starts_when_those_that_it_follows_are_over(build_module, tmp_path):
    package_build = build_module("package_build")
    file = tmp_path / "order"
    builds = [
        RecordedBuild(package_build, file, "user", uses="used"),
        RecordedBuild(package_build, file, "used"),
    ]
    reported: list[tuple[int, int]] = []
    package_build.build_all(builds, lambda _label, done, total: reported.append((done, total)))
    order = file.read_text().splitlines()
    steps = [f"{package} {step}" for package in ("used", "user") for step in ("a", "b", "first")]
    assert sorted(order) == steps
    assert order[0] == "used first"
    assert order.index("user first") < min(order.index("user a"), order.index("user b"))
    assert reported == [(done, 6) for done in range(1, 7)]


def test_packages_that_use_each_other_are_named(build_module, tmp_path):
    package_build = build_module("package_build")
    builds = [
        RecordedBuild(package_build, tmp_path / "order", "one", uses="other"),
        RecordedBuild(package_build, tmp_path / "order", "other", uses="one"),
    ]
    with pytest.raises(build_module("errors").BuildError, match="in a circle: one, other"):
        package_build.build_all(builds, lambda *_: None)


def test_largest_package_is_built_first(packages):
    sizes = [len(package.interfaces) for package in packages]
    assert sizes == sorted(sizes, reverse=True)


def test_every_generated_file_is_compiled_once(build_module, packages, tmp_path):
    units = build_module("translation_unit")
    folder = build_module("work_folder").WorkFolder
    for package in packages:
        found = units.find_units(package, folder(tmp_path, package.name))
        for kind in units.CODE_KINDS:
            sources = [one for unit in found if unit.kind == kind for one in unit.sources]
            assert len(sources) == len(set(sources)) == len(package.interfaces)


def test_no_two_units_write_the_same_object(build_module, packages, tmp_path):
    folder = build_module("work_folder").WorkFolder
    for package in packages:
        found = build_module("translation_unit").find_units(package, folder(tmp_path, package.name))
        objects = [unit.object_file for unit in found]
        assert len(objects) == len(set(objects))


def test_missing_compilers_are_named_with_the_remedy(build_module, monkeypatch):
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.delenv("CXX", raising=False)
    with pytest.raises(build_module("errors").MissingToolError) as caught:
        build_module("toolchain").find_toolchain()
    sentence = str(caught.value)
    assert "lacks gcc and g++" in sentence
    assert "apt install gcc g++ python3-dev" in sentence


def test_missing_python_header_is_named(build_module, monkeypatch, tmp_path):
    toolchain = build_module("toolchain")
    monkeypatch.setattr(toolchain, "python_header", lambda: tmp_path / "Python.h")
    with pytest.raises(build_module("errors").MissingToolError, match=r"Python\.h"):
        toolchain.find_toolchain()


def test_compiler_error_is_shown(build_module, tmp_path):
    source = tmp_path / "broken.c"
    source.write_text("int main(void) { return undeclared; }", encoding="utf-8")
    toolchain = build_module("toolchain").find_toolchain()
    with pytest.raises(build_module("errors").CompileError, match="undeclared"):
        toolchain.compile(source, tmp_path / "broken.o", [], "-O0")


def test_progress_tells_how_far_the_build_is(build_module):
    stream = io.StringIO()
    build_module("command").BuildProgress("arm_interfaces", stream).report("linked x", 3, 4)
    assert stream.getvalue() == "arm_interfaces: [ 75 %] linked x\n"


def test_a_lazy_package_imports_a_class_on_its_first_use(build_module, tmp_path, monkeypatch):
    package = tmp_path / "lazy_example"
    package.mkdir()
    for name in ("first", "second"):
        (package / f"_{name}.py").write_text(f"class {name.title()}: ...\n")
    generated = "".join(
        f"from lazy_example._{name} import {name.title()}  # noqa: F401\n"
        for name in ("first", "second")
    )
    lazy = build_module("lazy_imports").make_lazy(generated, "lazy_example")
    (package / "__init__.py").write_text(lazy)
    monkeypatch.syspath_prepend(str(tmp_path))
    example = importlib.import_module("lazy_example")
    assert {"First", "Second"} <= set(dir(example))
    assert not {"lazy_example._first", "lazy_example._second"} & set(sys.modules)
    assert example.First.__module__ == "lazy_example._first"
    assert "lazy_example._second" not in sys.modules
    with pytest.raises(AttributeError, match=r"'lazy_example' has no attribute 'Third'"):
        _ = example.Third


def test_templates_read_once_give_the_same_text(build_module):
    code = """
import em, io
from interface_build import generator_caches
template = '@[for n in names]@[if n == "b"]second@[else]other@[end if]\\n@[end for]@{m = 2}@(m)'
def expand(names):
    output = io.StringIO()
    interpreter = em.Interpreter(
        config=em.Configuration(defaultStdout=output, useProxy=True), dispatcher=False
    )
    interpreter.string(template, locals={"names": names})
    text = output.getvalue()
    interpreter.shutdown()
    return text
plain = expand("ab"), expand("bc")
generator_caches.install()
assert (expand("ab"), expand("bc"), expand("ab")) == (*plain, plain[0]), plain
print(plain[1])
"""
    found = output_of(code, DISTRIBUTIONS[0])
    assert found == "second\nother\n2\n"


def test_messages_of_one_package_load_those_of_the_others():
    code = (
        "from moveit_msgs.msg import CollisionObject; "
        "from rclpy.serialization import deserialize_message, serialize_message; "
        "one = CollisionObject(id='box'); one.type.key = 'crate'; "
        "print(deserialize_message(serialize_message(one), CollisionObject).type.key)"
    )
    found = output_of(code)
    assert found == "crate\n"


def test_an_installed_package_imports_only_what_is_used():
    code = (
        "import sys; from control_msgs.msg import PidState; import control_msgs.action; "
        "print(*sorted(m for m in sys.modules if m.startswith('control_msgs.')))"
    )
    found = output_of(code)
    assert found.split() == [
        "control_msgs.action",
        "control_msgs.msg",
        "control_msgs.msg._pid_state",
    ]
