"""The parts of the build that can be tried without building."""

import importlib
import io
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

DISTRIBUTION = Path(__file__).parents[2] / "arm_interfaces"


@pytest.fixture
def build_module(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Import a module of the build, which is never installed."""
    monkeypatch.syspath_prepend(str(DISTRIBUTION))
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def load(name: str) -> ModuleType:
        return importlib.import_module(f"interface_build.{name}")

    return load


@pytest.fixture
def packages(build_module: Any) -> Any:
    """The packages of the source tree."""
    return build_module("interface_package").find_packages(DISTRIBUTION / "interfaces")


def test_source_tree_holds_the_recorded_types(
    packages: Any, expected_types: dict[str, Any]
) -> None:
    found = {
        f"{package.name}/{interface.kind}/{interface.name}"
        for package in packages
        for interface in package.interfaces
    }
    assert found == set(expected_types)


def test_largest_package_is_built_first(packages: Any) -> None:
    sizes = [len(package.interfaces) for package in packages]
    assert sizes == sorted(sizes, reverse=True)


def test_every_generated_file_is_compiled_once(
    build_module: Any, packages: Any, tmp_path: Path
) -> None:
    units = build_module("translation_unit")
    folder = build_module("work_folder").WorkFolder
    for package in packages:
        found = units.find_units(package, folder(tmp_path, package.name))
        for kind in units.CODE_KINDS:
            sources = [one for unit in found if unit.kind == kind for one in unit.sources]
            assert len(sources) == len(set(sources)) == len(package.interfaces)


def test_no_two_units_write_the_same_object(
    build_module: Any, packages: Any, tmp_path: Path
) -> None:
    folder = build_module("work_folder").WorkFolder
    for package in packages:
        found = build_module("translation_unit").find_units(package, folder(tmp_path, package.name))
        objects = [path for unit in found for path in unit.object_files]
        assert len(objects) == len(set(objects))


def test_missing_compilers_are_named_with_the_remedy(
    build_module: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.delenv("CC", raising=False)
    monkeypatch.delenv("CXX", raising=False)
    with pytest.raises(build_module("errors").MissingToolError) as caught:
        build_module("toolchain").find_toolchain()
    sentence = str(caught.value)
    assert "lacks gcc and g++" in sentence
    assert "apt install gcc g++ python3-dev" in sentence


def test_missing_python_header_is_named(
    build_module: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    toolchain = build_module("toolchain")
    monkeypatch.setattr(toolchain, "python_header", lambda: tmp_path / "Python.h")
    with pytest.raises(build_module("errors").MissingToolError, match=r"Python\.h"):
        toolchain.find_toolchain()


def test_compiler_error_is_shown(build_module: Any, tmp_path: Path) -> None:
    source = tmp_path / "broken.c"
    source.write_text("int main(void) { return undeclared; }", encoding="utf-8")
    toolchain = build_module("toolchain").find_toolchain()
    with pytest.raises(build_module("errors").CompileError, match="undeclared"):
        toolchain.compile(source, tmp_path / "broken.o", [], "-O0")


def test_progress_tells_how_far_the_build_is(build_module: Any) -> None:
    stream = io.StringIO()
    build_module("progress").BuildProgress(stream).report("linked x", 3, 4)
    assert stream.getvalue() == "arm_interfaces: [ 75 %] linked x\n"


def test_a_lazy_package_imports_a_class_on_its_first_use(
    build_module: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
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


def test_an_installed_package_imports_only_what_is_used() -> None:
    code = (
        "import sys; from control_msgs.msg import PidState; import control_msgs.action; "
        "print(*sorted(m for m in sys.modules if m.startswith('control_msgs.')))"
    )
    found = subprocess.run(
        [sys.executable, "-c", code], check=True, capture_output=True, text=True
    ).stdout
    assert found.split() == [
        "control_msgs.action",
        "control_msgs.msg",
        "control_msgs.msg._pid_state",
    ]
