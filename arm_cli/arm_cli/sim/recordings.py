"""`arm sim record`, `replay` and `diff`: runs are recorded, run again and compared."""

import argparse
import math
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from arm_cli.arguments import Argument, Flag, positive_number, verb
from arm_cli.errors import ArmCliError, StoppedError, UnansweredError
from arm_cli.output import complain, print_json, say, say_answer
from arm_cli.ros.connection import connect
from arm_cli.sim.simulation import NAMESPACE, ask_simulation

if TYPE_CHECKING:
    from arm_cli.ros.replayed_run import RunBag
    from arm_gazebo.recording.replay import Difference, Replay, ReplayResult
    from arm_gazebo.recording.run_file import RecordedInput

PARAMETER = "record_run"
MAX_ARGUMENTS = 120
"""Characters of an input's arguments that are printed."""
BLOBS = ("model", "saved")
"""Arguments in a binary form, which are not printed."""
PROGRESS_S = 0.25
"""Wall time between two lines of --json."""
MIN_PART_S, MAX_PART_S = 0.5, 10.0
"""Wall time in which a file of --bag is written with --json: as long as all before it."""
_REFUSED = " (refused)"


@verb(
    Argument("file", type=Path, help="the file to write; the simulation writes it"),
    Argument(
        "--duration",
        metavar="S",
        type=positive_number,
        default=math.inf,
        help="end after this wall time in seconds (default: at Ctrl-C)",
    ),
    NAMESPACE,
)
def record(options: argparse.Namespace) -> None:
    """Record the inputs and states of a running simulation until Ctrl-C."""
    # A relative path is relative to this process, not to the simulation's working folder.
    path = options.file.absolute()
    with ask_simulation(options.namespace) as simulation:
        simulation.set_parameter(PARAMETER, str(path))
        say(f"recording to {path}; Ctrl-C ends it")
        try:
            simulation.session.spin_for(options.duration)
        except StoppedError:
            simulation.session.clear_stop()
        # A simulation that ends, as at Ctrl-C in its launch, ends its recording by itself.
        with suppress(UnansweredError):
            simulation.set_parameter(PARAMETER, "", if_there=True)
    with _sentences():
        _say_recorded(path)


def _say_recorded(path: Path) -> None:
    from arm_gazebo.recording.run_file import RecordingEnd, RunFile

    ends = (record for record in RunFile(path).records() if isinstance(record, RecordingEnd))
    end = next(ends, None)
    if end is None:
        raise ArmCliError(f"the recording {path} has no end; the simulation's log says why")
    say(f"{end.periods} control periods in {path}, {path.stat().st_size / 1e6:.1f} MB")
    if end.reason:
        say(f"the recording ended because {end.reason}")


@verb(
    Argument("file", type=Path, help="a recording of arm sim record"),
    Argument(
        "--until",
        metavar="TIME",
        type=positive_number,
        help="stop at this simulation time in seconds, and print where the joints are",
    ),
    Flag("--inputs", help="print each input and its time"),
    Flag(
        "--publish", help="publish clock, joint states and transforms, the last ones until Ctrl-C"
    ),
    Argument(
        "--speed",
        type=positive_number,
        default=1.0,
        help="simulated seconds per second, with --publish (default: 1)",
    ),
    Argument(
        "--bag",
        metavar="DIR",
        type=Path,
        help="write clock, joint states, transforms, shapes and contacts as a bag",
    ),
    Flag(
        "--json",
        help="print a line of JSON now and then, and what was found as the last one; with --bag, "
        "such a line names each file that is complete",
    ),
)
def replay(options: argparse.Namespace) -> int:
    """Run a recording again; return 1 unless every control period is equal."""
    if options.bag and options.publish:
        raise ArmCliError("--bag and --publish: a replay is either written or published")
    with _sentences():
        from arm_gazebo.recording.replay import Replay
        from arm_gazebo.recording.run_file import RunFile
        from arm_gazebo.state.made_with import machine_differences

        file = RunFile(options.file)
        others = machine_differences(file.header.get("made_with", {}))
        if others:
            complain(
                f"{options.file} was made with {', '.join(others)}; equal bits are promised for "
                "the same machine and versions only"
            )
        run = Replay(file)
        if options.publish:
            result = _published(run, options)
        elif options.bag:
            result = _written(run, options)
        else:
            result = _replayed(run, options)
    return 1 if result.difference is not None or not result.periods else 0


def _replayed(
    run: "Replay",
    options: argparse.Namespace,
    show: Callable[[], object] = lambda: None,
    bag: "RunBag | None" = None,
) -> "ReplayResult":
    """Run and compare, and print what was found; `show` and `bag` take each equal period."""

    def say_input(item: "RecordedInput") -> None:
        where = " ".join(filter(None, (item.controller, item.method)))
        words = " ".join(filter(None, (where, _brief(item))))
        time_s = run.simulation.time_s
        found = {"time_s": time_s, "input": words, "refused": item.raised}
        say_answer(options, found, [f"{time_s:.3f} s: {words}{_REFUSED * item.raised}"])

    progress = _Progress(run, bag) if options.json else None

    def after_period() -> None:
        show()
        if progress is not None:
            progress.tell()

    before_input = say_input if options.inputs else _ignore
    until_s = math.inf if options.until is None else options.until
    began_s = time.monotonic()
    result = run.run(until_s, after_period, before_input)
    wall_s = time.monotonic() - began_s
    if progress is not None:
        print_json({"result": {**asdict(result), "wall_s": wall_s, **progress.lengths}})
        return result
    _say_result(options.file, result, wall_s)
    if options.until is not None:
        _say_joints(run)
    return result


class _Progress:
    """Tells in JSON how far a replay is, at once and every PROGRESS_S.

    A bag gets a new file from time to time, so that what is equal so far can be read at once.

    Attributes:
        lengths: length of the recording and of a period.
    """

    def __init__(self, run: "Replay", bag: "RunBag | None") -> None:
        self._run = run
        self._bag = bag
        self.lengths = {
            "of_periods": run.file.count_periods(),
            "period_s": run.simulation.timing.period_s,
        }
        self._began_s = time.monotonic()
        self._told_s = -math.inf
        self._split_s = self._began_s + MIN_PART_S
        self.tell()

    def tell(self) -> None:
        now_s = time.monotonic()
        if now_s - self._told_s < PROGRESS_S:
            return
        self._told_s = now_s
        told: dict[str, object] = {"periods": self._run.periods, **self.lengths}
        if self._bag is not None and now_s >= self._split_s:
            self._split_s = now_s + min(now_s - self._began_s, MAX_PART_S)
            told["file"] = self._bag.split()
        print_json(told)


def _published(run: "Replay", options: argparse.Namespace) -> "ReplayResult":
    """Run, publish and compare; then publish the last state until Ctrl-C."""
    from arm_cli.ros.replayed_run import RunPlayer

    with connect() as session:
        player = RunPlayer(session, run, options.speed)
        result = _replayed(run, options, player.show)
        with suppress(StoppedError):
            player.hold()
    return result


def _written(run: "Replay", options: argparse.Namespace) -> "ReplayResult":
    """Run and compare, and write what was equal as a bag."""
    from arm_cli.ros.replayed_run import RunBag

    with closing(RunBag(options.bag, run)) as bag:
        return _replayed(run, options, bag.show, bag)


def _ignore(_item: "RecordedInput") -> None:
    """Do nothing."""


def _brief(item: "RecordedInput") -> str:
    """Return the arguments of an input, shortened."""
    text = " ".join(
        f"{name}={value}" for name, value in item.arguments.items() if name not in BLOBS
    )
    text = " ".join(text.split())
    return text if len(text) <= MAX_ARGUMENTS else f"{text[:MAX_ARGUMENTS]}..."


def _say_result(path: Path, result: "ReplayResult", wall_s: float) -> None:
    if result.difference is not None:
        _say_difference(result.difference)
    elif not result.periods:
        complain(f"{path} holds no control period, so nothing was compared")
    if result.periods:
        equal = "the first " if result.difference is not None else ""
        say(
            f"{equal}{result.periods} control periods are equal, up to {result.time_s:.3f} s "
            f"(replayed in {wall_s:.2f} s)"
        )
    if result.is_cut_off:
        say("the recording has no end: the process that wrote it was killed, or is still writing")
    if result.end_reason:
        say(f"the recording ended because {result.end_reason}")


def _say_difference(difference: "Difference") -> None:
    say(f"control period {difference.period}, at {difference.time_s:.3f} s, differs:")
    say(*(f"  {line}" for line in difference.lines))


def _say_joints(run: "Replay") -> None:
    say(f"joints at {run.simulation.time_s:.3f} s:")
    data = run.simulation.data
    for name, joint in run.simulation.built.joints.items():
        position, velocity = data.qpos[joint.qpos_address], data.qvel[joint.dof_address]
        say(f"  {name}: position {position:.6f}, velocity {velocity:.6f}")


@verb(
    Argument("first", type=Path, help="a recording of arm sim record"),
    Argument("second", type=Path, help="another one"),
)
def diff(options: argparse.Namespace) -> int:
    """Name the first difference of two recordings; return 1 if there is one."""
    with _sentences():
        from arm_gazebo.recording.comparison import compare
        from arm_gazebo.recording.run_file import RunFile

        result = compare(RunFile(options.first), RunFile(options.second))
    say(*result.settings)
    if result.difference is not None:
        _say_difference(result.difference)
    say(f"{result.periods} control periods are equal")
    if result.longer:
        which, count = ("second", result.longer) if result.longer > 0 else ("first", -result.longer)
        say(f"the {which} recording has {count} more control periods")
    return 0 if result.is_equal and result.periods else 1


@contextmanager
def _sentences() -> Iterator[None]:
    """Turn the errors of recordings and simulations into errors of the command line."""
    from arm_control.errors import ArmControlError
    from arm_description.errors import DescriptionError
    from arm_gazebo.errors import GazeboError

    try:
        yield
    except (GazeboError, ArmControlError, DescriptionError) as error:
        raise ArmCliError(str(error)) from error
