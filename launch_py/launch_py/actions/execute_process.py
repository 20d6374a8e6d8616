"""Starts and supervises a process."""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any, TypedDict, Unpack

from launch_py.action import Action, check_actions
from launch_py.conditions import Condition
from launch_py.errors import LaunchError, LaunchFileError, NotFoundError, UnavailableError
from launch_py.event_handlers import OnProcessExit, Reaction
from launch_py.launch_context import LaunchContext, LaunchSurvey
from launch_py.near_names import describe_known
from launch_py.plan.readiness import Readiness
from launch_py.plan.restart_policy import RestartPolicy
from launch_py.plan.steps import (
    SIGKILL_TIMEOUT_S,
    SIGTERM_TIMEOUT_S,
    GeneratedFile,
    ProcessStep,
    StopDelays,
    Trigger,
    TriggerKind,
)
from launch_py.substitution import Text, keep_list, perform_text
from launch_py.system.packages import Packages
from launch_py.system.programs import find_program
from launch_py.typed_values import perform_boolean, perform_seconds

BOTH = frozenset({"stdout", "stderr"})

SHOWN_BY_WORD = {
    "screen": BOTH,
    "both": BOTH,
    "full": BOTH,
    "log": frozenset({"stderr"}),
    "own_log": frozenset({"stderr"}),
}
"""ROS's words. Those that name the log still show stderr on the screen."""

STREAMS_BY_KEY = {
    "stdout": frozenset({"stdout"}),
    "stderr": frozenset({"stderr"}),
    "both": BOTH,
}

Output = Text | Mapping[Any, Any]

Variables = Mapping[Text, Text]


class ProcessOptions(TypedDict, total=False):
    """The options that every process takes besides its command; see `ExecuteProcess`."""

    ready: Readiness | Iterable[Readiness]
    depends_on: Action | str | Iterable[Action | str]
    restart: RestartPolicy | None
    on_exit: Reaction | None
    prefix: Text | None
    output: Output
    emulate_tty: bool | Text
    cwd: Text | None
    env: Variables | None
    additional_env: Variables | None
    respawn: bool | Text
    respawn_delay: float | None
    respawn_max_retries: int
    log_cmd: bool
    cached_output: bool
    sigterm_timeout: float | Text
    sigkill_timeout: float | Text
    condition: Condition | None


class ExecuteProcess(Action):
    """A command line that starts when the processes it depends on are ready.

    Args:
        cmd: the words of the command, each a text.
        name: its name in output, log files and `depends_on`; default the program's name.
        ready: one `Readiness` or several that must all hold; by default a process is ready once
            started.
        depends_on: actions or process names that must be ready before this process starts.
        restart: the restart policy; `respawn`, `respawn_delay` and `respawn_max_retries` are
            ROS's notation for `RestartPolicy("always", ...)`.
        on_exit: actions, or a function of event and context, to run when it exits and is not
            restarted; `on_exit=Shutdown()` makes it a required process.
        shell: run the words, joined by spaces, as one line of /bin/sh.
        prefix: words put before the command, as in "gdb -ex run --args".
        output: "screen" (default), or "log" to show stderr only and log everything; or a dict such
            as {"stdout": "log", "stderr": "screen"}, which shows the streams marked "screen".
        emulate_tty: run it on a pseudo terminal, because some programs colour or buffer their
            output differently there.
        cwd: its working folder.
        env: the whole environment, instead of the inherited one.
        additional_env: variables added to the inherited environment.
        sigterm_timeout: seconds from SIGINT to SIGTERM during the shutdown.
        sigkill_timeout: seconds from SIGTERM to SIGKILL.
        log_cmd: accepted as in ROS, without effect: `--print` shows all commands.
        cached_output: accepted as in ROS, without effect: the log folder keeps the output.
        condition: whether to start it.
    """

    starts_process = True

    def __init__(
        self,
        *,
        cmd: Iterable[Text],
        name: Text | None = None,
        ready: Readiness | Iterable[Readiness] = (),
        depends_on: Action | str | Iterable[Action | str] = (),
        restart: RestartPolicy | None = None,
        on_exit: Reaction | None = None,
        shell: bool = False,
        prefix: Text | None = None,
        output: Output = "screen",
        emulate_tty: bool | Text = False,
        cwd: Text | None = None,
        env: Variables | None = None,
        additional_env: Variables | None = None,
        respawn: bool | Text = False,
        respawn_delay: float | None = None,
        respawn_max_retries: int = -1,
        log_cmd: bool = False,
        cached_output: bool = False,
        sigterm_timeout: float | Text = SIGTERM_TIMEOUT_S,
        sigkill_timeout: float | Text = SIGKILL_TIMEOUT_S,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(condition=condition)
        self.cmd: Sequence[Text] = keep_list(cmd, "cmd=")
        self.name = name
        self.ready = (ready,) if isinstance(ready, Readiness) else tuple(ready)
        self.depends_on = (
            (depends_on,) if isinstance(depends_on, Action | str) else tuple(depends_on)
        )
        for process in self.depends_on:
            if not isinstance(process, Action | str):
                raise LaunchFileError(f"depends_on= takes actions and names, not {process!r}")
        if not isinstance(restart, RestartPolicy | None):
            raise LaunchFileError(f"restart= takes a RestartPolicy, not {restart!r}")
        self.restart = restart
        self.on_exit = on_exit
        self.shell = shell
        self.prefix = prefix or ""
        self.output = output
        self.emulate_tty = emulate_tty
        self.cwd = cwd
        self.env = env
        self.additional_env = additional_env or {}
        self.respawn = respawn
        self.respawn_delay = respawn_delay or 0.0
        self.respawn_max_retries = respawn_max_retries
        self.sigterm_timeout = sigterm_timeout
        self.sigkill_timeout = sigkill_timeout

    def expand(self, context: LaunchContext) -> None:
        """Add the process, and the actions that follow its exit, to the plan.

        A known program of ROS that nothing replaces here is left out, with a warning.

        Raises:
            LaunchError: its program does not exist, or an argument is invalid.
        """
        namespace = self.resolve_namespace(context)
        name = self.process_name(context)
        try:
            command = self._with_prefix(context, self.command_words(context))
        except UnavailableError as error:
            context.warnings.append(f"{name} is skipped: {error}")
            return
        context.plan.add(
            ProcessStep(
                after=(*context.after, *(Trigger(TriggerKind.READY, t) for t in self.depends_on)),
                delay_s=context.delay_s,
                action=self,
                node_names=self.node_names(context),
                name=name,
                command=command,
                cwd=None if self.cwd is None else perform_text(context, self.cwd),
                environment=self._environment(context),
                replace_environment=self.env is not None,
                shown=perform_shown_streams(context, self.output, name),
                emulate_tty=perform_boolean(context, self.emulate_tty, f"emulate_tty of {name}"),
                ready=tuple(
                    condition.resolve(context.perform_substitution, namespace)
                    for condition in self.ready
                ),
                restart=self._restart_policy(context),
                stop_delays=StopDelays(
                    perform_seconds(context, self.sigterm_timeout, "sigterm_timeout"),
                    perform_seconds(context, self.sigkill_timeout, "sigkill_timeout"),
                ),
            )
        )
        if self.on_exit is not None:
            OnProcessExit(target_action=self, on_exit=self.on_exit).expand(context)

    def survey(self, survey: LaunchSurvey, context: LaunchContext) -> None:
        """Record the process's name, if it is known, and the actions that follow its exit."""
        super().survey(survey, context)
        with suppress(LaunchError):
            survey.process_names.add(self.process_name(context))
        if self.on_exit is not None and not callable(self.on_exit):
            for action in check_actions(self.on_exit, "on_exit"):
                action.survey(survey, context)

    def process_name(self, context: LaunchContext) -> str:
        """Return the process's name."""
        if self.name is not None:
            return perform_text(context, self.name)
        words = perform_text(context, self.cmd[0]).split() if self.cmd else []
        return os.path.basename(words[0]) if words else "process"

    def resolve_namespace(self, context: LaunchContext) -> str:
        """Return the namespace of relative names in its readiness conditions."""
        return context.namespace

    def node_names(self, context: LaunchContext) -> Callable[[], Sequence[str]]:
        """Return a function that finds the full names of its ROS nodes; here they are unknown."""
        return tuple

    def command_words(self, context: LaunchContext) -> tuple[str | GeneratedFile, ...]:
        """Return the command line with the path of its program."""
        words = [perform_text(context, word) for word in self.cmd]
        if not words or not words[0]:
            raise LaunchFileError("ExecuteProcess needs cmd=[program, argument, ...]")
        if self.shell:
            return ("/bin/sh", "-c", self._shell_line(context, " ".join(words)))
        return (*self.find(context, words[0]), *words[1:])

    def describe(self) -> str:
        """Return its name in messages."""
        return f"an ExecuteProcess of {self.name or self.cmd}"

    def _shell_line(self, context: LaunchContext, line: str) -> str:
        """Return a shell line, with its first word replaced if the program has a stand-in."""
        first = line.split(maxsplit=1)[0] if line.strip() else ""
        with suppress(NotFoundError):
            found = self.find(context, first)
            if os.path.basename(found[0]) != os.path.basename(first):
                return shlex.join(found) + line.lstrip().removeprefix(first)
        return line  # The first word may be a builtin of the shell.

    def _with_prefix(
        self, context: LaunchContext, command: tuple[str | GeneratedFile, ...]
    ) -> tuple[str | GeneratedFile, ...]:
        text = perform_text(context, self.prefix)
        if not text.strip():
            return command
        words = shlex.split(text)
        return (*self.find(context, words[0]), *words[1:], *command)

    def find(self, context: LaunchContext, program: str) -> tuple[str, ...]:
        """Return the path of a program, or the command line of its stand-in.

        Raises:
            NotFoundError: neither exists; see `find_program`.
            UnavailableError: it is a program of ROS that nothing replaces here.
        """
        path = context.environment_variable("PATH") or ""
        if os.sep in program and self.cwd is not None:
            # Absolute, because the process resolves it after changing to that folder.
            program = os.path.join(os.path.abspath(perform_text(context, self.cwd)), program)
        try:
            return (find_program(program, path),)
        except NotFoundError:
            packages = Packages(context.base_environment)
            stand_in = packages.stand_in(program)
            if stand_in is not None:
                return stand_in
            # rviz2 and others are the only executable of a package of their name.
            name = os.path.basename(program)
            listed = packages.stand_in_of(name, name)
            if listed is None:
                raise
            command = packages.executable(name, name)
            context.warnings.append(listed.remark)
            return command

    def _environment(self, context: LaunchContext) -> dict[str, str | None]:
        for given in (self.env, self.additional_env):
            if not isinstance(given, Mapping | None):
                raise LaunchFileError(f"env= and additional_env= take a dict, not {given!r}")
        variables: dict[str, str | None] = {} if self.env is not None else dict(context.environment)
        for name, value in {**(self.env or {}), **self.additional_env}.items():
            variables[perform_text(context, name)] = perform_text(context, value)
        return variables

    def _restart_policy(self, context: LaunchContext) -> RestartPolicy:
        if self.restart is not None:
            return self.restart
        if not perform_boolean(context, self.respawn, f"respawn of {self.process_name(context)}"):
            return RestartPolicy()
        policy = RestartPolicy("always", first_delay_s=self.respawn_delay, factor=1.0)
        retries = self.respawn_max_retries
        if retries < 0:
            return policy
        # The policy must not give up before the requested retries are used up.
        give_up_after = max(policy.give_up_after, retries + 1)
        return replace(policy, max_restarts=retries, give_up_after=give_up_after)


def refuse_unknown_options(action: Action, options: Iterable[str], own: Iterable[str]) -> None:
    """Check the options that an action passes on to ExecuteProcess.

    Raises:
        LaunchFileError: there is no such option.
    """
    for name in options:
        if name not in ProcessOptions.__annotations__:
            known = describe_known(name, (*ProcessOptions.__annotations__, *own), "it takes")
            raise LaunchFileError(f"{type(action).__name__} takes no argument {name!r}; {known}")


def perform_shown_streams(context: LaunchContext, output: Output, process: str) -> frozenset[str]:
    """Return the streams that are shown.

    A stream that the dict does not put on the screen is in the log file only.

    Raises:
        LaunchFileError: a key or a word is unknown.
    """
    if not isinstance(output, Mapping):
        return SHOWN_BY_WORD[_known(context, output, SHOWN_BY_WORD, f"output={{!r}} of {process}")]
    shown: frozenset[str] = frozenset()
    for key, value in output.items():
        stream = _known(context, key, STREAMS_BY_KEY, f"the key {{!r}} in output= of {process}")
        many = isinstance(value, Iterable) and not isinstance(value, str | Mapping)
        for item in value if many else (value,):
            where = f"{stream}: {{!r}} in output= of {process}"
            if "stdout" in SHOWN_BY_WORD[_known(context, item, SHOWN_BY_WORD, where)]:
                shown |= STREAMS_BY_KEY[stream]
    return shown


def _known(context: LaunchContext, value: Any, known: Iterable[str], where: str) -> str:
    """Return the word that `value` stands for; `where` describes it, with {!r} for the word."""
    known = sorted(known)
    if isinstance(value, Mapping):
        raise LaunchFileError(f"{where.format(value)}: a word is needed, not a dict")
    word = perform_text(context, value)
    if word not in known:
        raise LaunchFileError(
            f"{where.format(word)}; {describe_known(word, known, 'the choices are')}"
        )
    return word


class Executable:
    """A command line, and the folder and variables that it runs with; see `ExecuteProcess`."""

    def __init__(
        self,
        *,
        cmd: Iterable[Text],
        prefix: Text | None = None,
        name: Text | None = None,
        cwd: Text | None = None,
        env: Mapping[Text, Text] | None = None,
        additional_env: Mapping[Text, Text] | None = None,
        arguments: Iterable[Text] | None = None,
    ) -> None:
        self.cmd = keep_list(cmd, "cmd=")
        self.prefix = prefix
        self.name = name
        self.cwd = cwd
        self.env = env
        self.additional_env = additional_env
        self.arguments = keep_list(arguments, "arguments=")


class ExecuteLocal(ExecuteProcess):
    """A process that an `Executable` describes; the other options are those of ExecuteProcess."""

    def __init__(
        self,
        *,
        process_description: Executable,
        shell: bool = False,
        **options: Unpack[ProcessOptions],
    ) -> None:
        refuse_unknown_options(self, options, ("process_description", "shell"))
        self.process_description = described = process_description
        if not isinstance(described, Executable):
            raise LaunchFileError(f"process_description= takes an Executable, not {described!r}")
        own: ProcessOptions = {
            "prefix": described.prefix,
            "cwd": described.cwd,
            "env": described.env,
            "additional_env": described.additional_env,
        }
        own.update(options)
        words = [*described.cmd, *described.arguments]
        super().__init__(cmd=words, name=described.name, shell=shell, **own)
