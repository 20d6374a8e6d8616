"""Installations of the suite, each made from a copy of the sources: the repository stays clean."""

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import tomllib
import venv
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DESCRIBE = Path(__file__).with_name("describe_installation.py")
TIMEOUT_S = 300.0
BUILT_BY_COLCON = frozenset(
    {
        "arm_control",
        "arm_controller",
        "arm_description",
        "arm_node",
        "arm_planning",
        "launch_py",
        "urdf_tutorial",
    }
)
"""Packages of every kind, modules, data and executables, with what they need.

Each takes colcon seconds. `test_setup_files.py` looks at what every setup.py gives to setuptools.
"""


@dataclass(frozen=True)
class Project:
    """The root pyproject.toml of a source tree.

    Attributes:
        root: the tree.
        only: the packages that are looked at; empty for all.
    """

    root: Path
    only: frozenset[str] = frozenset()

    def is_looked_at(self, package: str) -> bool:
        """Whether a package is one of those."""
        return not self.only or package in self.only

    @cached_property
    def table(self) -> dict:
        """The whole file."""
        return tomllib.loads((self.root / "pyproject.toml").read_text())

    @property
    def packages(self) -> list[str]:
        """The packages of the wheel that hold modules, each a folder of the root."""
        folders = self.table["tool"]["hatch"]["build"]["targets"]["wheel"]["dev-mode-dirs"]
        return [package for package in folders if self.is_looked_at(package)]

    @property
    def data_packages(self) -> dict[str, Path]:
        """The packages of the wheel that hold data only: name to folder."""
        sources = (Path(source) for source in self.shared_data)
        manifests = [source for source in sources if source.name == "package.xml"]
        return {
            manifest.parent.name: manifest.parent
            for manifest in manifests
            if len(manifest.parts) > 2 and self.is_looked_at(manifest.parent.name)
        }

    @property
    def shared_data(self) -> dict[str, str]:
        """Where the wheel puts files that are no modules: source to target."""
        return self.table["tool"]["hatch"]["build"]["targets"]["wheel"]["shared-data"]

    @property
    def scripts(self) -> dict[str, str]:
        """The console scripts: name to `module:function`."""
        scripts: dict[str, str] = self.table["project"]["scripts"]
        return {n: call for n, call in scripts.items() if self.is_looked_at(call.split(".")[0])}

    def data_files(self) -> list[str]:
        """Every file that belongs below share/, relative to it."""
        found: list[str] = []
        for source, target in self.shared_data.items():
            path, place = self.root / source, Path(target).relative_to("share")
            # Either a file below the package's folder, or its line in the index of all packages.
            if not (self.is_looked_at(place.parts[0]) or self.is_looked_at(place.name)):
                continue
            files = [path] if path.is_file() else [p for p in path.rglob("*") if p.is_file()]
            kept = [file for file in files if "__pycache__" not in file.parts]
            found += [str(place / file.relative_to(path)) for file in kept]
        return sorted(found)


@dataclass(frozen=True)
class Installation:
    """A place where the suite is installed, and how a process is started there."""

    project: Project
    python: Path
    modules: Path
    shares: Callable[[str], Path]
    executable: Callable[[str], Path]
    environment: Mapping[str, str]

    def run(self, *command: str | Path, folder: Path) -> subprocess.CompletedProcess[str]:
        """Run a command in a folder outside the sources."""
        return run(command, folder, self.environment)

    @cached_property
    def description(self) -> dict:
        """What a process of this installation says of itself: see describe_installation.py."""
        command = [self.python, DESCRIBE, *self.project.packages]
        return json.loads(run(command, Path("/"), self.environment).stdout)


def run(
    command: Sequence[str | Path], folder: Path, environment: Mapping[str, str]
) -> subprocess.CompletedProcess[str]:
    """Run a command to its end; one that fails fails the test with all that it said."""
    done = subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        env=dict(environment),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
        check=False,
    )
    if done.returncode:
        pytest.fail(f"{command} ended with {done.returncode}:\n{done.stdout}\n{done.stderr}")
    return done


def pip(*arguments: str | Path, into: Path, folder: Path) -> None:
    """Run this environment's pip for another Python; no constraint of a CI run concerns it."""
    run([sys.executable, "-m", "pip", "-q", "--python", into, *arguments], folder, bare())


def make_environment(folder: Path) -> Path:
    """Make a virtual environment that finds this one's dependencies; return its Python.

    A line of a .pth file adds a folder without the .pth files in it, so an editable installation
    of the suite in this environment does not leak into the new one.
    """
    venv.create(folder, symlinks=True)
    packages = Path(sysconfig.get_path("purelib", "venv", {"base": str(folder)}))
    (packages / "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n")
    return folder / "bin" / "python"


def bare() -> dict[str, str]:
    """Return this process's environment without what leads to packages or constrains pip.

    What the ROS wheels' bootstrap has set stays: they need it in every process. pip compiles
    nothing, because little of what it installs is imported.
    """
    left_out = ("AMENT_PREFIX_PATH", "PYTHONPATH", "PIP_CONSTRAINT")
    kept = {name: value for name, value in os.environ.items() if name not in left_out}
    return {**kept, "PIP_COMPILE": "0"}


def environment_of(prefixes: str, **variables: str) -> dict[str, str]:
    """Return the environment of a process: these prefixes, then the ROS packages of this one."""
    return {**bare(), "AMENT_PREFIX_PATH": f"{prefixes}{os.pathsep}{sys.prefix}", **variables}


def copy_sources(folder: Path) -> Project:
    """Copy what the root wheel is made of."""
    ignored = [line.rstrip("/") for line in (ROOT / ".gitignore").read_text().split()]
    project = Project(ROOT)
    for package in (*project.packages, *project.data_packages.values()):
        shutil.copytree(ROOT / package, folder / package, ignore=shutil.ignore_patterns(*ignored))
    for name in ("pyproject.toml", "hatch_build.py", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, folder / name)
    return Project(folder)


def in_environment(project: Project, prefix: Path, python: Path, modules: Path) -> Installation:
    """Return an installation by pip into an environment."""
    return Installation(
        project,
        python,
        modules,
        shares=lambda _package: prefix / "share",
        executable=lambda name: prefix / "bin" / name,
        environment=environment_of(str(prefix)),
    )


@pytest.fixture(scope="session")
def project() -> Project:
    """The project as it stands in the repository; only to be read."""
    return Project(ROOT)


@pytest.fixture(scope="session")
def distributions(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the source archives of all distributions, and the suite's wheel.

    The wheel is built from its archive, and each in an environment of its own, as for an index.
    """
    folder = tmp_path_factory.mktemp("distributions")
    sources = copy_sources(folder / "sources")
    build = [sys.executable, "-m", "build", "--outdir", folder / "dist"]
    run([*build, sources.root], folder, bare())
    for name in ("arm_interfaces", "arm_moveit_interfaces"):
        left_out = shutil.ignore_patterns("build")
        # The second has links to the first.
        shutil.copytree(ROOT / name, folder / "interfaces" / name, symlinks=True, ignore=left_out)
    for interfaces in sorted((folder / "interfaces").iterdir()):
        run([*build, "--sdist", interfaces], folder, bare())
    # What is installed from the wheel must not need them.
    shutil.rmtree(sources.root)
    shutil.rmtree(folder / "interfaces")
    return folder / "dist"


@pytest.fixture(scope="session")
def wheel(distributions: Path) -> Path:
    """The suite's wheel."""
    (built,) = distributions.glob("*.whl")
    return built


def install_wheel(folder: Path, wheel: Path) -> Installation:
    """Install the built wheel into an environment of its own."""
    python = make_environment(folder / "venv")
    # Forced: pip takes the suite of the outer environment, seen through the .pth, for this one.
    pip("install", "--no-deps", "--force-reinstall", wheel, into=python, folder=folder)
    return in_environment(Project(ROOT), folder / "venv", python, folder / "venv")


def install_editable(folder: Path, _wheel: Path) -> Installation:
    """Do `pip install -e .` in an environment of its own."""
    sources = copy_sources(folder / "sources")
    python = make_environment(folder / "venv")
    pip("install", "--no-deps", "-e", sources.root, into=python, folder=folder)
    return in_environment(sources, folder / "venv", python, sources.root)


@pytest.fixture(scope="session")
def description_alone(tmp_path_factory: pytest.TempPathFactory) -> Installation:
    """What `pip install ./arm_description` installs, in an environment of its own."""
    folder = tmp_path_factory.mktemp("description_alone")
    sources = copy_sources(folder / "sources")
    python = make_environment(folder / "venv")
    pip("install", sources.root / "arm_description", into=python, folder=folder)
    return in_environment(sources, folder / "venv", python, folder / "venv")


def install_by_colcon(folder: Path, _wheel: Path) -> Installation:
    """Do `colcon build` and take the environment that its set-up script makes."""
    sources = copy_sources(folder / "sources")
    python = make_environment(folder / "venv")
    pip("install", "colcon-common-extensions", into=python, folder=folder)
    colcon = folder / "venv/bin/colcon"
    run([colcon, "build", "--packages-select", *BUILT_BY_COLCON], sources.root, bare())
    install = sources.root / "install"
    built = Project(sources.root, BUILT_BY_COLCON)
    sourced = run(["bash", "-c", f". {install}/local_setup.bash && env -0"], folder, bare())
    variables = dict(line.split("=", 1) for line in sourced.stdout.split("\0") if line)
    owners = {name: target.split(".")[0] for name, target in built.scripts.items()}
    return Installation(
        built,
        python,
        install,
        shares=lambda package: install / package / "share",
        executable=lambda name: install / owners[name] / "lib" / owners[name] / name,
        environment=environment_of(
            variables["AMENT_PREFIX_PATH"], PYTHONPATH=variables["PYTHONPATH"]
        ),
    )


@pytest.fixture(
    scope="session",
    params=[install_wheel, install_editable, install_by_colcon],
    ids=["wheel", "editable", "colcon"],
)
def installation(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, wheel: Path
) -> Installation:
    """The suite, installed in one of the three ways."""
    return request.param(tmp_path_factory.mktemp(request.param.__name__), wheel)
