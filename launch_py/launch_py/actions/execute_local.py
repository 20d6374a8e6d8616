"""A process by its description, named as in ROS 2's `launch.descriptions`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Unpack

from launch_py.actions.execute_process import ExecuteProcess, ProcessOptions
from launch_py.errors import LaunchFileError
from launch_py.substitution import Text


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
        self.cmd = [cmd] if isinstance(cmd, str) else list(cmd)
        self.prefix = prefix
        self.name = name
        self.cwd = cwd
        self.env = env
        self.additional_env = additional_env
        self.arguments = list(arguments or ())


class ExecuteLocal(ExecuteProcess):
    """A process that an `Executable` describes; the other options are those of ExecuteProcess."""

    def __init__(
        self,
        *,
        process_description: Executable,
        shell: bool = False,
        **options: Unpack[ProcessOptions],
    ) -> None:
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
