"""The command lines of spawner, unspawner and hardware_spawner, and how the three run."""

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NoReturn

from arm_control.errors import ArmControlError, WaitInterruptedError
from arm_control.lifecycle import LifecycleState
from arm_node.names import as_node_name
from arm_node.process import EXIT_OK, NodeProcess
from arm_node.task import Task, run_task
from arm_node.workarounds.exit_pause import end_process

MANAGER, SWITCH, SERVICE_CALL = (
    "controller-manager-timeout",
    "switch-timeout",
    "service-call-timeout",
)
_TIMEOUTS = {
    MANAGER: (0.0, "for the controller manager; 0 waits for ever"),
    SWITCH: (5.0, "for a switch, as in a paused simulation; 0 means 1 s"),
    SERVICE_CALL: (10.0, "for an answer before asking again"),
}


def absolute_name(manager: str, namespace: str) -> str:
    """Return the manager's absolute name; a relative one belongs to a namespace.

    The namespace is that of the client's node, with or without the leading slash.
    """
    if manager.startswith("/"):
        return manager
    prefix = namespace.strip("/")
    return f"/{prefix}/{manager}" if prefix else f"/{manager}"


def _add_controller_manager(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "-c",
        "--controller-manager",
        default="controller_manager",
        metavar="NODE",
        help="name of the controller manager's node (default: %(default)s)",
    )


def _add_timeout(parser: argparse.ArgumentParser, name: str) -> None:
    """Add one of the timeouts; what is parsed has its name with its unit."""
    default_s, meaning = _TIMEOUTS[name]
    parser.add_argument(
        f"--{name}",
        dest=f"{name.replace('-', '_')}_s",
        type=_positive_seconds if name == SERVICE_CALL else _seconds,
        default=default_s,
        metavar="SECONDS",
        help=f"how long to wait {meaning} (default: %(default)s)",
    )


def _seconds(text: str) -> float:
    """Convert a timeout that may be 0."""
    try:
        seconds = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a number of seconds, not '{text}'") from None
    if not 0.0 <= seconds < float("inf"):
        raise argparse.ArgumentTypeError(f"must be 0 or positive, not {text}")
    return seconds


def _positive_seconds(text: str) -> float:
    """Convert a timeout that must not be 0."""
    seconds = _seconds(text)
    if seconds == 0.0:
        raise argparse.ArgumentTypeError("must be positive, not 0")
    return seconds


@dataclass(frozen=True, slots=True)
class UnspawnerOptions:
    """The options of an unspawner.

    Attributes:
        names: controllers, in the order in which to unload them.
        controller_manager: node name of the manager, absolute or relative to the namespace.
        switch_timeout_s: how long the manager may take to switch; 0 for its default.
    """

    names: tuple[str, ...]
    controller_manager: str
    switch_timeout_s: float


def parse_unspawner_options(arguments: Sequence[str]) -> UnspawnerOptions:
    """Parse the unspawner's arguments; an error ends the process with code 2."""
    parser = argparse.ArgumentParser(
        prog="unspawner", description="Deactivate and unload controllers.", allow_abbrev=False
    )
    parser.add_argument("names", nargs="+", metavar="NAME", help="controllers, in this order")
    _add_controller_manager(parser)
    _add_timeout(parser, SWITCH)
    options = parser.parse_intermixed_args(arguments)
    options.names = tuple(options.names)
    return UnspawnerOptions(**vars(options))


@dataclass(frozen=True, slots=True)
class HardwareSpawnerOptions:
    """The options of a hardware spawner.

    Attributes:
        names: hardware components, in the order in which to change them.
        target: the state to bring them to.
        controller_manager: node name of the manager, absolute or relative to the namespace.
        controller_manager_timeout_s: how long to wait for the manager; 0 for ever.
    """

    names: tuple[str, ...]
    target: LifecycleState
    controller_manager: str
    controller_manager_timeout_s: float


def parse_hardware_spawner_options(arguments: Sequence[str]) -> HardwareSpawnerOptions:
    """Parse the hardware spawner's arguments; an error ends the process with code 2."""
    parser = argparse.ArgumentParser(
        prog="hardware_spawner",
        description="Configure or activate hardware components.",
        allow_abbrev=False,
    )
    parser.add_argument("names", nargs="+", metavar="NAME", help="components, in this order")
    _add_controller_manager(parser)
    _add_timeout(parser, MANAGER)
    target = parser.add_mutually_exclusive_group(required=True)
    for flag, state, meaning in (
        ("--activate", LifecycleState.ACTIVE, "configure and activate them"),
        ("--configure", LifecycleState.INACTIVE, "configure them, so that they are inactive"),
    ):
        target.add_argument(flag, action="store_const", const=state, dest="target", help=meaning)
    options = parser.parse_intermixed_args(arguments)
    options.names = tuple(options.names)
    return HardwareSpawnerOptions(**vars(options))


_ROS_ARGUMENTS = "--controller-ros-args"
_OF_CONTROLLER = ("param_files", "ros_args", "load_only", "inactive")


@dataclass(frozen=True, slots=True)
class ControllerOptions:
    """A spawner's options for one controller.

    Attributes:
        name: name of the controller.
        param_files: parameter files for it; a later one overrides an earlier one.
        ros_args: ROS arguments for its node.
        configure: whether to configure it after loading.
        activate: whether to activate it after configuring.
        unload_on_kill: whether to unload it when the spawner ends.
    """

    name: str
    param_files: tuple[str, ...] = ()
    ros_args: tuple[str, ...] = ()
    configure: bool = True
    activate: bool = True
    unload_on_kill: bool = False


@dataclass(frozen=True, slots=True)
class SpawnerOptions:
    """The options of a spawner.

    Attributes:
        controllers: in the order in which to start them.
        controller_manager: node name of the manager, absolute or relative to the namespace.
        namespace: namespace of the controllers; empty for the spawner node's namespace.
        unload_on_kill: whether to keep running, and to unload controllers at the end.
        controller_manager_timeout_s: how long to wait for the manager; 0 for ever.
        switch_timeout_s: how long the manager may take to switch; 0 for its default.
        service_call_timeout_s: how long to wait for an answer before asking again.
        activate_as_group: whether to activate all in one switch.
        switch_asap: passed on to the manager.
    """

    controllers: tuple[ControllerOptions, ...]
    controller_manager: str
    namespace: str
    unload_on_kill: bool
    controller_manager_timeout_s: float
    switch_timeout_s: float
    service_call_timeout_s: float
    activate_as_group: bool
    switch_asap: bool


def parse_spawner_options(
    arguments: Sequence[str], forwarded_files: Sequence[str] = ()
) -> SpawnerOptions:
    """Parse the spawner's arguments; an error ends the process with code 2.

    Args:
        arguments: without the program's name and without ROS arguments.
        forwarded_files: parameter files of the spawner's own node, which every controller gets
            after its own files.
    """
    parser = _parser()
    # Intermixed, to allow options between the names.
    options = parser.parse_intermixed_args(_with_values_joined(arguments))
    drafts: list[dict[str, Any]] = options.drafts
    if options.names and drafts:
        parser.error("give all names as arguments, or each name with --controller")
    if not options.names and not drafts:
        parser.error("the following arguments are required: NAME or --controller NAME")
    common = vars(options)
    return SpawnerOptions(
        controllers=tuple(
            _controller_options(draft, options, forwarded_files)
            for draft in drafts or [{**common, "name": name} for name in options.names]
        ),
        controller_manager=options.controller_manager,
        namespace=options.namespace,
        unload_on_kill=options.unload_on_kill,
        controller_manager_timeout_s=options.controller_manager_timeout_s,
        switch_timeout_s=options.switch_timeout_s,
        service_call_timeout_s=options.service_call_timeout_s,
        activate_as_group=options.activate_as_group,
        switch_asap=options.switch_asap,
    )


class _BeginController(argparse.Action):
    """Starts the options of one controller."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        common = {dest: getattr(namespace, dest) for dest in _OF_CONTROLLER}
        namespace.drafts = [*namespace.drafts, {"name": values, **common}]


class _OfController(argparse.Action):
    """Stores an option for the last named controller, or for all if none is named yet."""

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        values: Any,
        option_string: str | None = None,
    ) -> None:
        place = namespace.drafts[-1] if namespace.drafts else vars(namespace)
        place[self.dest] = True if self.nargs == 0 else (*place[self.dest], values)


def _controller_options(
    draft: dict[str, Any], options: argparse.Namespace, forwarded_files: Sequence[str]
) -> ControllerOptions:
    stays = draft["load_only"] or draft["inactive"]
    return ControllerOptions(
        name=draft["name"],
        param_files=(*draft["param_files"], *forwarded_files),
        ros_args=tuple(word for words in draft["ros_args"] for word in words.split()),
        configure=not draft["load_only"],
        activate=not stays,
        # Controllers given with --controller that stay inactive are not unloaded.
        unload_on_kill=options.unload_on_kill and not (options.drafts and stays),
    )


def _with_values_joined(arguments: Sequence[str]) -> list[str]:
    """Join `--controller-ros-args` and its value, which often looks like an option itself."""
    joined: list[str] = []
    for argument in arguments:
        if joined and joined[-1] == _ROS_ARGUMENTS:
            joined[-1] = f"{_ROS_ARGUMENTS}={argument}"
        else:
            joined.append(argument)
    return joined


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="spawner",
        usage="spawner [options] NAME [NAME ...]\n"
        "       spawner [options] --controller NAME [options] [--controller NAME [options] ...]",
        description="Load, configure and activate controllers.",
        allow_abbrev=False,
    )
    parser.add_argument(
        "names", nargs="*", default=[], metavar="NAME", help="controllers to start, in this order"
    )
    _add_controller_manager(parser)
    parser.add_argument(
        "-n",
        "--namespace",
        default="",
        help="deprecated: give the namespace with --ros-args -r __ns:=/x",
    )
    parser.add_argument(
        "-u",
        "--unload-on-kill",
        action="store_true",
        help="keep running; deactivate and unload the controllers at the end",
    )
    for name in _TIMEOUTS:
        _add_timeout(parser, name)
    parser.add_argument(
        "--activate-as-group",
        action="store_true",
        help="activate all controllers in one switch instead of one after the other",
    )
    parser.add_argument(
        "--switch-asap",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="passed to the controller manager; the suite's one always switches between cycles",
    )
    _add_controller_options(parser)
    return parser


def _add_controller_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group(
        "options of a controller",
        "After --controller NAME they apply to that controller only, otherwise to all.",
    )
    group.add_argument(
        "--controller",
        action=_BeginController,
        dest="drafts",
        default=[],
        metavar="NAME",
        help="a controller with its own options",
    )
    for flags, dest, metavar, meaning in (
        (
            ("-p", "--param-file"),
            "param_files",
            "FILE",
            "parameter file; may be given several times, a later one overrides",
        ),
        (
            (_ROS_ARGUMENTS,),
            "ros_args",
            "ARGS",
            "ROS arguments for the controller's node as one argument, such as '-r ~/a:=/b'; "
            "may be given several times",
        ),
    ):
        group.add_argument(
            *flags, action=_OfController, dest=dest, default=(), metavar=metavar, help=meaning
        )
    for flag, meaning in (
        ("--load-only", "load, but do not configure"),
        ("--inactive", "configure, but do not activate"),
    ):
        group.add_argument(flag, action=_OfController, nargs=0, default=False, help=meaning)


def run_manager_task(node_name: str, task: Task, argv: Sequence[str]) -> NoReturn:
    """Run a client of a controller manager and end this process, with 0 after a signal.

    Characters of the name that ROS does not allow become underscores. An `ArmControlError` of the
    task is reported to the user and gives exit code 1.
    """

    def until_interrupted(node: Any, process: NodeProcess) -> int:
        try:
            return task(node, process)
        except WaitInterruptedError:
            return EXIT_OK

    name = as_node_name(node_name)
    end_process(run_task(name, until_interrupted, argv, user_errors=(ArmControlError,)))
