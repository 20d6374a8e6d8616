"""The text of --print: what would be started, without starting it."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from pathlib import Path

from launch_py.child_environment import default_environment
from launch_py.plan import (
    GeneratedFile,
    MessageStep,
    Plan,
    ProcessStep,
    ShutdownStep,
    Step,
)

MAX_TEXT = 300
"""A longer parameter file (a robot description is in it) is cut."""


def list_plan(plan: Plan, environ: Mapping[str, str]) -> str:
    """Return the steps of a plan, and what is added to the environment of all processes."""
    lines = ["Environment added for all processes:"]
    added = default_environment(environ, Path("<log folder>"), "<socket>", colours=False)
    lines += [f"  {name}={value}" for name, value in sorted(added.items())]
    for step in plan.steps:
        lines += ["", *_describe(step)]
    return "\n".join(lines) + "\n"


def _describe(step: Step) -> Iterator[str]:
    match step:
        case ProcessStep():
            yield step.name
            yield f"  command      {_command(step)}"
            yield from _process_details(step)
        case MessageStep():
            yield f"message {step.text!r}"
        case ShutdownStep():
            yield "shutdown" + (f" {step.reason!r}" if step.reason else "")
        case _:
            yield "actions that a function of the launch file decides"
    waits = [f"{trigger.process} {trigger.kind.value}" for trigger in step.after]
    if waits:
        yield f"  starts after {', '.join(waits)}"
    if step.delay_s:
        yield f"  delay        {step.delay_s:g} s"


def _process_details(step: ProcessStep) -> Iterator[str]:
    if step.cwd is not None:
        yield f"  folder       {step.cwd}"
    for name, value in step.environment.items():
        yield f"  environment  {name}={value}" if value is not None else f"  without      {name}"
    for condition in step.ready:
        yield f"  ready        {type(condition).__name__}, within {condition.timeout_s:g} s"
        yield f"               (else: {condition.missing()})"
    if step.restart.when != "never":
        yield f"  restart      {step.restart.when}"
    for word in step.command:
        if isinstance(word, GeneratedFile):
            text = word.text if len(word.text) <= MAX_TEXT else word.text[:MAX_TEXT] + " ..."
            yield f"  parameters   {text.strip()}"


def _command(step: ProcessStep) -> str:
    words = [
        f"<generated{word.suffix}>" if isinstance(word, GeneratedFile) else shlex.quote(word)
        for word in step.command
    ]
    return " ".join(words)
