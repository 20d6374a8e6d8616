"""Starts and supervises a process."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, TypedDict

from launch_py.actions.action import Action, check_actions
from launch_py.errors import LaunchError, LaunchFileError
from launch_py.event_handlers import OnProcessExit, Reaction
from launch_py.plan import (
    SIGKILL_TIMEOUT_S,
    SIGTERM_TIMEOUT_S,
    GeneratedFile,
    ProcessStep,
    StopDelays,
    Trigger,
    TriggerKind,
)
from launch_py.programs import find_program
from launch_py.readiness import Readiness
from launch_py.restart_policy import RestartPolicy
from launch_py.seconds import perform_seconds
from launch_py.shown_streams import Output, perform_shown_streams
from launch_py.substitution import Text, perform_text
from launch_py.truth import perform_truth

if TYPE_CHECKING:
    from launch_py.conditions import Condition
    from launch_py.launch_context import LaunchContext
    from launch_py.survey import Survey

Variables = Mapping[Text, Text]


class ProcessOptions(TypedDict, total=False):
    """What every process takes besides what it runs; `ExecuteProcess` says what it means."""

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
    """A command line, started when what it depends on is ready.

    Args:
        cmd: the words of the command, each a text.
        name: what to call it in output, log files and `depends_on`; default the program's name.
        ready: one `Readiness` or several that must all hold; none means ready once started.
        depends_on: actions or process names that must be ready before this one starts.
        restart: the restart policy; `respawn`, `respawn_delay` and `respawn_max_retries` are
            ROS's way to say `RestartPolicy("always", ...)`.
        on_exit: actions, or a function of event and context, for when it has ended for good;
            `on_exit=Shutdown()` makes it a required process.
        shell: run the words, joined by spaces, as one line of /bin/sh.
        prefix: words put before the command, as in "gdb -ex run --args".
        output: "screen" (default), or "log" for the log file only, where stderr still shows; or a
            dict as {"stdout": "log", "stderr": "screen"}, of which only "screen" is shown.
        emulate_tty: give it a terminal to write to, for programs that colour or buffer otherwise.
        cwd: the folder to run it in.
        env: the whole environment, instead of the inherited one.
        additional_env: variables added to the inherited environment.
        sigterm_timeout: seconds from SIGINT to SIGTERM when it is stopped.
        sigkill_timeout: seconds from SIGTERM to SIGKILL.
        log_cmd: taken as in ROS, and does nothing: `--print` shows all commands.
        cached_output: taken as in ROS, and does nothing: the output is in the log folder.
        condition: whether it is started.
    """

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
        self.cmd: Sequence[Text] = [cmd] if isinstance(cmd, str) else list(cmd)
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
        """Add the process, and what follows its end, to the plan.

        Raises:
            LaunchError: its program does not exist, or something given does not make sense.
        """
        namespace = self.resolve_namespace(context)
        command = self._with_prefix(context, self.command_words(context))
        name = self.process_name(context)
        context.plan.add(
            ProcessStep(
                after=(*context.after, *(Trigger(TriggerKind.READY, t) for t in self.depends_on)),
                delay_s=context.delay_s,
                action=self,
                name=name,
                command=command,
                cwd=None if self.cwd is None else perform_text(context, self.cwd),
                environment=self._environment(context),
                replace_environment=self.env is not None,
                shown=perform_shown_streams(context, self.output, name),
                emulate_tty=perform_truth(context, self.emulate_tty, f"emulate_tty of {name}"),
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

    def survey(self, survey: Survey, context: LaunchContext) -> None:
        """Note the process's name where it is known, and the actions that follow its end."""
        super().survey(survey, context)
        with suppress(LaunchError):
            survey.process_names.add(self.process_name(context))
        if self.on_exit is not None and not callable(self.on_exit):
            for action in check_actions(self.on_exit, "on_exit"):
                action.survey(survey, context)

    def process_name(self, context: LaunchContext) -> str:
        """Return what to call the process."""
        if self.name is not None:
            return perform_text(context, self.name)
        words = perform_text(context, self.cmd[0]).split() if self.cmd else []
        return os.path.basename(words[0]) if words else "process"

    def resolve_namespace(self, context: LaunchContext) -> str:
        """Return the namespace in which relative names of its readiness are meant."""
        return context.namespace

    def command_words(self, context: LaunchContext) -> tuple[str | GeneratedFile, ...]:
        """Return the command line, its program found."""
        words = [perform_text(context, word) for word in self.cmd]
        if not words or not words[0]:
            raise LaunchFileError("ExecuteProcess needs cmd=[program, argument, ...]")
        if self.shell:
            return ("/bin/sh", "-c", " ".join(words))
        return (self.find(context, words[0]), *words[1:])

    def describe(self) -> str:
        """Return what to call it in a message."""
        return f"an ExecuteProcess of {self.name or self.cmd}"

    def _with_prefix(
        self, context: LaunchContext, command: tuple[str | GeneratedFile, ...]
    ) -> tuple[str | GeneratedFile, ...]:
        text = perform_text(context, self.prefix)
        if not text.strip():
            return command
        import shlex

        words = shlex.split(text)
        return (self.find(context, words[0]), *words[1:], *command)

    def find(self, context: LaunchContext, program: str) -> str:
        """Return the path of a program; see `find_program`."""
        path = context.environment_variable("PATH") or ""
        if os.sep in program and self.cwd is not None:
            # Absolute: the process looks for it when it is in that folder already.
            program = os.path.join(os.path.abspath(perform_text(context, self.cwd)), program)
        return find_program(program, path)

    def _environment(self, context: LaunchContext) -> dict[str, str | None]:
        variables: dict[str, str | None] = {} if self.env is not None else dict(context.environment)
        for name, value in {**(self.env or {}), **self.additional_env}.items():
            variables[perform_text(context, name)] = perform_text(context, value)
        return variables

    def _restart_policy(self, context: LaunchContext) -> RestartPolicy:
        if self.restart is not None:
            return self.restart
        if not perform_truth(context, self.respawn, f"respawn of {self.process_name(context)}"):
            return RestartPolicy()
        policy = RestartPolicy("always", first_delay_s=self.respawn_delay, factor=1.0)
        retries = self.respawn_max_retries
        if retries < 0:
            return policy
        # Whoever counts the retries wants them all.
        patience = max(policy.give_up_after, retries + 1)
        return replace(policy, max_restarts=retries, give_up_after=patience)
