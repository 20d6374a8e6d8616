"""Actions for nodes, named as in ROS 2's `launch_ros.actions`."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, Unpack

from launch_py.action import Action
from launch_py.actions.execute_process import ExecuteProcess, ProcessOptions, refuse_unknown_options
from launch_py.actions.grouping import TimerAction
from launch_py.conditions import Condition
from launch_py.errors import NodeParameterError
from launch_py.launch_context import LaunchContext
from launch_py.plan.steps import GeneratedFile
from launch_py.ros.parameter_descriptions import (
    ParameterFile,
    ParameterSource,
    files_in_order,
    source_of_values,
)
from launch_py.ros.parameters import (
    ParameterValue,
    evaluate_parameters,
    parameter_file_text,
    parameters_by_node,
)
from launch_py.substitution import (
    Pairs,
    Text,
    describe_text,
    join_names,
    keep_list,
    keep_pairs,
    perform_pairs,
    perform_text,
)
from launch_py.system.packages import Packages

Parameters = Mapping[Any, Any] | ParameterFile | Text

NODE_OPTIONS = (
    "package",
    "executable",
    "name",
    "namespace",
    "exec_name",
    "parameters",
    "remappings",
    "arguments",
    "ros_arguments",
)
"""The arguments of `Node` beside those of every process."""


class Node(ExecuteProcess):
    """A process with one or more nodes, from an executable of a package.

    The other options are those of `ExecuteProcess`.

    Args:
        package: the package. A script of a Python distribution whose module is in the package
            takes precedence over a program in <prefix>/lib/<package>.
        executable: the name of the script or program; without a package its path, or its name on
            PATH.
        name: the node's name. It renames *every* node of the process, so leave it out for a
            process with several nodes; use `exec_name` to name the process.
        namespace: the namespace, inside that of `PushRosNamespace`.
        exec_name: the name of the process; default the node's name, else the executable's.
        parameters: parameter files, each a path or a `ParameterFile`, and dicts; later ones win. A
            dict holds the parameters of the node `name`, or without a name those of every node of
            the process. For a process with several nodes it may have the form of a file,
            {node: {"ros__parameters": {...}}}. Its node names are relative to this namespace unless
            they start with a slash.
        remappings: pairs of an old and a new name, or a dict.
        arguments: arguments of the program itself.
        ros_arguments: arguments after --ros-args.
    """

    def __init__(
        self,
        *,
        executable: Text,
        package: Text | None = None,
        name: Text | None = None,
        namespace: Text | None = None,
        exec_name: Text | None = None,
        parameters: Iterable[Parameters] | None = None,
        remappings: Pairs | None = None,
        arguments: Iterable[Text] | None = None,
        ros_arguments: Iterable[Text] | None = None,
        **options: Unpack[ProcessOptions],
    ) -> None:
        refuse_unknown_options(self, options, NODE_OPTIONS)
        super().__init__(cmd=(), name=exec_name or name or executable, **options)
        self.package = package
        self.executable = executable
        self.node_name = name
        self.namespace = namespace
        single = isinstance(parameters, Mapping)
        self.parameters = [parameters] if single else keep_list(parameters, "parameters=")
        self.remappings = keep_pairs(remappings)
        self.arguments = keep_list(arguments, "arguments=")
        self.ros_arguments = keep_list(ros_arguments, "ros_arguments=")

    def command_words(self, context: LaunchContext) -> tuple[str | GeneratedFile, ...]:
        """Return the command line.

        Raises:
            NotFoundError: there is no such package or executable.
            NodeParameterError: a parameter cannot be passed on.
        """
        words = [perform_text(context, word) for word in self.arguments]
        executable = perform_text(context, self.executable)
        if self.package is None:
            program = self.find(context, executable)
        else:
            package = perform_text(context, self.package)
            packages = Packages(context.base_environment)
            program = packages.executable(package, executable)
            found = packages.stand_in_of(package, executable)
            if found is not None:
                if found.remark:
                    context.warnings.append(found.remark)
                if not found.takes_ros_arguments:
                    return (*program, *words)
        ros: list[str | GeneratedFile] = []
        name = "" if self.node_name is None else perform_text(context, self.node_name)
        namespace = self.resolve_namespace(context)
        if name:
            ros += ["-r", f"__node:={name}"]
        if namespace:
            ros += ["-r", f"__ns:={namespace}"]
        for file in self._parameter_files(context, namespace, name):
            ros += ["--params-file", file]
        remappings = perform_pairs(context, self.remappings, "remappings=")
        for old, new in [*context.remappings, *remappings]:
            ros += ["-r", f"{old}:={new}"]
        ros += [perform_text(context, word) for word in self.ros_arguments]
        return (*program, *words, *(["--ros-args", *ros] if ros else []))

    def node_names(self, context: LaunchContext) -> Callable[[], Sequence[str]]:
        """Return a function that finds its nodes' names: the given name, else the program's."""
        namespace = self.resolve_namespace(context)
        if self.node_name is not None:
            name = perform_text(context, self.node_name)
            return lambda: (join_names(namespace, name),) if name else ()
        if self.package is None:
            return tuple
        executable = perform_text(context, self.executable)
        packages = Packages(context.base_environment)
        return lambda: [join_names(namespace, n) for n in packages.node_names(executable)]

    def process_name(self, context: LaunchContext) -> str:
        """Return the process's name."""
        name = super().process_name(context)
        return os.path.basename(name) if self.name is self.executable else name

    def resolve_namespace(self, context: LaunchContext) -> str:
        """Return the node's namespace with a leading slash, "" for the root."""
        own = "" if self.namespace is None else perform_text(context, self.namespace)
        return join_names(context.namespace, own)

    def describe(self) -> str:
        """Return its name in messages."""
        return f"a Node of executable {describe_text(self.executable)!r}"

    def _parameter_files(
        self, context: LaunchContext, namespace: str, name: str
    ) -> Sequence[str | GeneratedFile]:
        sources: list[ParameterSource] = []
        try:
            for parameters in [*context.parameters, *self.parameters]:
                if isinstance(parameters, Mapping):
                    sources += _source(context, namespace, name, parameters)
                    continue
                if not isinstance(parameters, ParameterFile):
                    parameters = ParameterFile(parameters)
                sources.append(ParameterSource(parameters.evaluate(context)))
            return files_in_order(sources, _full_name(namespace, name) if name else "")
        except NodeParameterError as error:
            raise NodeParameterError(f"{self.process_name(context)}: {error}") from None


def _source(
    context: LaunchContext, namespace: str, name: str, parameters: Mapping[Any, Any]
) -> Iterator[ParameterSource]:
    """Yield the source of the parameters in a dict, if it has any."""
    by_node = {
        _full_name(namespace, node) if node else "/**": evaluate_parameters(context, values)
        for node, values in parameters_by_node(parameters, name).items()
        if values
    }
    if by_node:
        texts = [parameter_file_text(node, values) for node, values in by_node.items()]
        yield source_of_values(by_node, "".join(texts))


def _full_name(namespace: str, node: str) -> str:
    return node if node.startswith("/") else f"{namespace}/{node}"


class PushRosNamespace(Action):
    """Puts the nodes that follow in this scope into a namespace."""

    def __init__(self, namespace: Text, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.namespace = namespace

    def expand(self, context: LaunchContext) -> None:
        """Extend the scope's namespace."""
        context.push_namespace(perform_text(context, self.namespace))


PushROSNamespace = PushRosNamespace
"""ROS has both spellings."""


class SetParameter(Action):
    """Sets a parameter of all nodes that follow in this scope; their own values win."""

    def __init__(self, name: Text, value: Any, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.name = name
        self.value = value

    def expand(self, context: LaunchContext) -> None:
        """Add the parameter to the scope."""
        name = perform_text(context, self.name)
        context.parameters.append(evaluate_parameters(context, {name: self.value}))


class SetUseSimTime(SetParameter):
    """Sets whether all nodes that follow in this scope take their time from /clock."""

    def __init__(self, value: bool | Text, *, condition: Condition | None = None) -> None:
        use_sim_time = ParameterValue(value, value_type=bool)
        super().__init__("use_sim_time", use_sim_time, condition=condition)


class SetParametersFromFile(Action):
    """Passes a parameter file to all nodes that follow in this scope; their own values win."""

    def __init__(self, filename: Text, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.filename = filename

    def expand(self, context: LaunchContext) -> None:
        """Add the file to the scope."""
        context.parameters.append(perform_text(context, self.filename))


class SetROSLogDir(Action):
    """Sets the folder that the nodes which follow in this scope write their own log files to."""

    def __init__(self, new_log_dir: Text, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.new_log_dir = new_log_dir

    def expand(self, context: LaunchContext) -> None:
        """Set the variable that rcl reads."""
        context.set_environment_variable("ROS_LOG_DIR", perform_text(context, self.new_log_dir))


class RosTimer(TimerAction):
    """A timer; unlike ROS's it counts real time, also beside a simulation."""


ROSTimer = RosTimer
"""ROS has both spellings."""


class SetRemap(Action):
    """Remaps a name for all nodes that follow in this scope."""

    def __init__(self, src: Text, dst: Text, *, condition: Condition | None = None) -> None:
        super().__init__(condition=condition)
        self.src = src
        self.dst = dst

    def expand(self, context: LaunchContext) -> None:
        """Add the remapping to the scope."""
        context.remappings.append(
            (perform_text(context, self.src), perform_text(context, self.dst))
        )
