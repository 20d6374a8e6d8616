"""The build steps of interface packages, and how they run on all cores."""

import functools
import multiprocessing
import os
import shutil
import sysconfig
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from interface_build import generation, library
from interface_build.errors import BuildError
from interface_build.interface_package import InterfacePackage
from interface_build.lazy_imports import make_lazy
from interface_build.ros_prefix import RosPrefix
from interface_build.toolchain import Toolchain
from interface_build.translation_unit import TranslationUnit, find_units
from interface_build.work_folder import WorkFolder


@dataclass(frozen=True, slots=True)
class BuildStep:
    """Work for one process.

    Attributes:
        label: text for the user when it is done.
        run: a picklable function without arguments.
    """

    label: str
    run: Callable[[], None]


@dataclass(frozen=True, slots=True)
class Stage:
    """Steps of one package that may run in parallel.

    Attributes:
        key: the package and the name of the stage.
        steps: the steps.
        after: keys of the stages that must be over before this one starts.
    """

    key: tuple[str, str]
    steps: tuple[BuildStep, ...]
    after: frozenset[tuple[str, str]]


@dataclass(frozen=True, slots=True)
class PackageBuild:
    """The inputs for the build of one package; sent to the worker processes.

    Attributes:
        package: the package to build.
        work: folder for intermediate files.
        prefix: the ROS 2 wheels.
        toolchain: the compilers.
        target: the package's folder in the finished tree.
    """

    package: InterfacePackage
    work: WorkFolder
    prefix: RosPrefix
    toolchain: Toolchain
    target: Path

    def stages(self) -> list[Stage]:
        """Return the stages with what each needs: descriptions, headers and libraries."""
        name = self.package.name
        describe = [BuildStep(f"described {name}", self._describe)]
        generate = [
            BuildStep(f"generated {name} {label}", functools.partial(self._generate, label))
            for label in generation.GENERATORS
        ]
        compile_units = [
            BuildStep(f"compiled {name} {unit.name}", functools.partial(self._compile, unit))
            for unit in find_units(self.package, self.work)
        ]
        finish = [BuildStep(f"finished {name}", self._finish)]
        return [
            self._stage("describe", describe, used="describe"),
            self._stage("generate", generate, own="describe"),
            self._stage("compile", compile_units, own="generate", used="generate"),
            self._stage("finish", finish, own="compile", used="finish"),
        ]

    def _stage(self, name: str, steps: list[BuildStep], own: str = "", used: str = "") -> Stage:
        """Return a stage that follows one of this package and one of each package that it uses."""
        after = {(package, used) for package in self.package.uses if used}
        if own:
            after.add((self.package.name, own))
        return Stage((self.package.name, name), tuple(steps), frozenset(after))

    @property
    def _includes(self) -> tuple[Path, ...]:
        """Include folders, the package's own first."""
        return (
            *self.work.include_folders,
            *self.prefix.include_folders(),
            Path(sysconfig.get_path("include")),
            Path(np.get_include()),
        )

    def _describe(self) -> None:
        generation.describe(self.package, self.work, self.prefix)

    def _generate(self, label: str) -> None:
        generation.GENERATORS[label](self.package, self.work, self.prefix)

    def _compile(self, unit: TranslationUnit) -> None:
        unit.compile(self.toolchain, self._includes)

    def _finish(self) -> None:
        """Link, copy the Python modules beside the libraries, and make their imports lazy."""
        library.link_libraries(
            self.package, self.work, self.prefix, self.toolchain, self._includes, self.target
        )
        for module in sorted(self.work.generated.rglob("*.py")):
            copy = self.target / module.relative_to(self.work.generated)
            copy.parent.mkdir(exist_ok=True)
            shutil.copyfile(module, copy)
        for kind in self.package.kinds:
            classes = self.target / kind / "__init__.py"
            lazy = make_lazy(classes.read_text(encoding="utf-8"), f"{self.package.name}.{kind}")
            classes.write_text(lazy, encoding="utf-8")


# With more workers the longest step dominates, and each C++ compiler takes 200 MB.
_MAX_WORKERS = 8


def build_all(builds: Sequence[PackageBuild], report: Callable[[str, int, int], None]) -> None:
    """Run all stages of all builds, each as soon as those that it follows are over.

    The worker processes are forked: spawning would start Python, with the ROS wheels even twice,
    for steps of a tenth of a second.

    Args:
        builds: the builds, the longest first.
        report: called after each step with its label, the completed steps and the total.

    Raises:
        BuildError: a step failed; running steps are finished, the others are dropped.
    """
    waiting = [stage for build in builds for stage in build.stages()]
    total = sum(len(stage.steps) for stage in waiting)
    done = 0
    over: set[tuple[str, str]] = set()
    running: dict[Future[None], tuple[BuildStep, Stage]] = {}
    with _create_pool() as pool:
        try:
            while waiting or running:
                ready = [stage for stage in waiting if stage.after <= over]
                waiting = [stage for stage in waiting if stage not in ready]
                for stage in ready:
                    running |= {pool.submit(step.run): (step, stage) for step in stage.steps}
                if not running:
                    names = ", ".join(sorted({stage.key[0] for stage in waiting}))
                    raise BuildError(f"these packages use each other in a circle: {names}")
                finished, _ = wait(running, return_when=FIRST_COMPLETED)
                for future in finished:
                    step, stage = running.pop(future)
                    future.result()
                    done += 1
                    report(step.label, done, total)
                    if all(other is not stage for _, other in running.values()):
                        over.add(stage.key)
        except BaseException:  # Also after Ctrl-C, no further step of the build starts.
            pool.shutdown(cancel_futures=True)
            raise


def _create_pool() -> ProcessPoolExecutor:
    """Start one worker per core that this process may use."""
    workers = min(len(os.sched_getaffinity(0)), _MAX_WORKERS)
    return ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("fork"))
