"""The part of ROS 2's `launch` that reads and visits a description, with upstream's interface.

Written as a package `launch` by the tests. `run(path, arguments)` does what `ros2 launch` does.
"""

from __future__ import annotations

import subprocess
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from types import SimpleNamespace
from typing import ClassVar


class LaunchContext:
    def __init__(self):
        self.launch_configurations = {}


class LaunchDescriptionEntity:
    def visit(self, context):
        return None

    def describe_sub_entities(self):
        return []

    def describe_conditional_sub_entities(self):
        return []


class LaunchDescription(LaunchDescriptionEntity):
    def __init__(self, initial_entities=None, *, deprecated_reason=None):
        self.__entities = list(initial_entities) if initial_entities is not None else []
        self.__deprecated_reason = deprecated_reason

    @property
    def deprecated(self):
        return self.__deprecated_reason is not None

    @property
    def deprecated_reason(self):
        return self.__deprecated_reason

    def visit(self, context):
        return self.__entities

    def describe_sub_entities(self):
        return self.__entities

    def get_launch_arguments_with_include_launch_description_actions(
        self, conditional_inclusion=False
    ):
        found = []

        def process(entities):
            for entity in entities:
                known = [declared.name for declared, _ in found]
                if isinstance(entity, DeclareLaunchArgument) and entity.name not in known:
                    found.append((entity, None))
                process(entity.describe_sub_entities())

        process(self.entities)
        return found

    def get_launch_arguments(self, conditional_inclusion=False):
        pairs = self.get_launch_arguments_with_include_launch_description_actions()
        return [declared for declared, _ in pairs]

    @property
    def entities(self):
        return self.__entities


class DeclareLaunchArgument(LaunchDescriptionEntity):
    def __init__(self, name, *, default_value=None, description=None, choices=None):
        self.name = name
        self.default_value = default_value
        self.description = description or "no description given"
        self.choices = choices

    def visit(self, context):
        if self.name not in context.launch_configurations:
            if self.default_value is None:
                raise RuntimeError(f"Required launch argument '{self.name}' was not provided.")
            context.launch_configurations[self.name] = self.default_value
        value = context.launch_configurations[self.name]
        if self.choices is not None and value not in self.choices:
            raise RuntimeError(f"Provided value '{value}' is not valid. Options: {self.choices}")


class ExecuteProcess(LaunchDescriptionEntity):
    codes: ClassVar[list[int]] = []

    def __init__(self, *, cmd, name=None, output="log", sigterm_timeout="5"):
        self.cmd = cmd
        self.sigterm_timeout = float(sigterm_timeout)

    def visit(self, context):
        ExecuteProcess.codes.append(subprocess.run(self.cmd, check=False).returncode)


class IncludeLaunchDescription(LaunchDescriptionEntity):
    def __init__(self, path, launch_arguments=()):
        self.path = path
        self.launch_arguments = launch_arguments

    def describe_sub_entities(self):
        return [read(self.path)]

    def visit(self, context):
        context.launch_configurations.update(self.launch_arguments)
        return [read(self.path)]


actions = SimpleNamespace(
    DeclareLaunchArgument=DeclareLaunchArgument,
    ExecuteProcess=ExecuteProcess,
    IncludeLaunchDescription=IncludeLaunchDescription,
)


def read(path):
    loader = SourceFileLoader("python_launch_file", path)
    module = module_from_spec(spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module.generate_launch_description()


def visit(entity, context):
    if not isinstance(entity, LaunchDescriptionEntity):
        raise RuntimeError(f"expected a LaunchDescriptionEntity, got {entity!r}")
    for inner in entity.visit(context) or ():
        visit(inner, context)


def show_args(path):
    """Print as `ros2 launch --show-args` does."""
    for declared in read(path).get_launch_arguments():
        print(f"'{declared.name}': {declared.description} default: {declared.default_value!r}")


def run(path, arguments):
    description = read(path)
    context = LaunchContext()
    context.launch_configurations.update(arguments)
    visit(description, context)
    return max(ExecuteProcess.codes, default=0)
