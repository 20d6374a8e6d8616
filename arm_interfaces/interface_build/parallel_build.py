"""Run the builds of several packages on all cores."""

import multiprocessing
import os
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait

from interface_build.package_build import BuildStep, PackageBuild

# With more workers the longest step dominates, and each C++ compiler takes 200 MB.
_MAX_WORKERS = 8


def build_all(builds: Sequence[PackageBuild], report: Callable[[str, int, int], None]) -> None:
    """Run all stages of all builds.

    The worker processes are forked: spawning would start Python, with the ROS wheels even twice,
    for steps of a tenth of a second.

    Args:
        builds: the builds, the longest first.
        report: called after each step with its label, the completed steps and the total.

    Raises:
        BuildError: a step failed; running steps are finished, the others are dropped.
    """
    stages = [build.stages() for build in builds]
    total = sum(len(stage) for build in stages for stage in build)
    done = 0
    with _create_pool() as pool:
        try:
            running: dict[Future[None], tuple[BuildStep, int]] = {}
            for index, build in enumerate(stages):
                _submit(pool, build.pop(0), index, running)
            while running:
                finished, _ = wait(running, return_when=FIRST_COMPLETED)
                for future in finished:
                    step, index = running.pop(future)
                    future.result()
                    done += 1
                    report(step.label, done, total)
                    stage_over = all(other != index for _, other in running.values())
                    if stage_over and stages[index]:
                        _submit(pool, stages[index].pop(0), index, running)
        except BaseException:  # Also after Ctrl-C, no further step of the build starts.
            pool.shutdown(cancel_futures=True)
            raise


def _create_pool() -> ProcessPoolExecutor:
    """Start one worker per core that this process may use."""
    workers = min(len(os.sched_getaffinity(0)), _MAX_WORKERS)
    return ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("fork"))


def _submit(
    pool: ProcessPoolExecutor,
    steps: Sequence[BuildStep],
    index: int,
    running: dict[Future[None], tuple[BuildStep, int]],
) -> None:
    """Hand the steps of one stage to the pool."""
    for step in steps:
        running[pool.submit(step.run)] = (step, index)
