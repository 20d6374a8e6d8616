"""The text of --show-args."""

from __future__ import annotations

from pathlib import Path

from launch_py.survey import ArgumentInfo, Survey


def list_arguments(survey: Survey, launch_file: Path) -> str:
    """Return one paragraph for each argument: name, default, choices, description."""
    if not survey.arguments:
        return f"{launch_file.name} has no arguments.\n"
    lines = [f"Arguments of {launch_file.name}, given as name:=value:", ""]
    for argument in survey.arguments.values():
        lines += _describe(argument, launch_file)
    return "\n".join(lines) + "\n"


def _describe(argument: ArgumentInfo, launch_file: Path) -> list[str]:
    default = "required" if argument.default is None else f"default {argument.default!r}"
    lines = [f"  {argument.name}  ({default})"]
    if argument.description:
        lines.append(f"      {argument.description}")
    if argument.choices:
        lines.append(f"      choices: {', '.join(argument.choices)}")
    if argument.launch_file is not None and argument.launch_file != launch_file:
        lines.append(f"      declared in {argument.launch_file.name}")
    return lines
