"""The texts of --show-args and --print."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from pathlib import Path

from launch_py.launch_context import ArgumentInfo, LaunchSurvey
from launch_py.plan.steps import (
    GeneratedFile,
    LaunchPlan,
    MessageStep,
    ProcessStep,
    ShutdownStep,
    Step,
)
from launch_py.printable import printable
from launch_py.system.child_environment import default_environment


def list_arguments(survey: LaunchSurvey, launch_file: Path) -> str:
    """Return one paragraph for each argument: name, default, choices, description."""
    if not survey.arguments:
        return f"{launch_file.name} has no arguments.\n"
    lines = [f"Arguments of {launch_file.name}, given as name:=value:", ""]
    for argument in survey.arguments.values():
        lines += _describe_argument(argument, launch_file)
    return "\n".join(map(printable, lines)) + "\n"


def _describe_argument(argument: ArgumentInfo, launch_file: Path) -> list[str]:
    default = "required" if argument.default is None else f"default {argument.default!r}"
    lines = [f"  {argument.name}  ({default})"]
    if argument.description:
        lines.append(f"      {argument.description}")
    if argument.choices:
        lines.append(f"      choices: {', '.join(argument.choices)}")
    if argument.launch_file is not None and argument.launch_file != launch_file:
        lines.append(f"      declared in {argument.launch_file.name}")
    return lines


MAX_TEXT = 300
"""A longer parameter file, such as one with a robot description, is cut."""


def list_plan(plan: LaunchPlan, environ: Mapping[str, str]) -> str:
    """Return the steps of a plan, and the variables that all processes get."""
    lines = [f"warning: {warning}" for warning in plan.warnings]
    lines.append("Environment added for all processes:")
    added = default_environment(environ, Path("<log folder>"), "<socket>", colours=False)
    lines += [f"  {name}={value}" for name, value in sorted(added.items())]
    for step in plan.steps:
        lines += ["", *_describe_step(step)]
    return "\n".join(map(printable, lines)) + "\n"


def _describe_step(step: Step) -> Iterator[str]:
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
