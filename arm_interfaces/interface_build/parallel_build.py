"""Run the builds of several packages on all cores."""

import multiprocessing
import os
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait

from interface_build.errors import BuildError
from interface_build.package_build import BuildStep, PackageBuild, Stage

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
