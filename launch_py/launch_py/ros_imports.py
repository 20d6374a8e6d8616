"""Lets launch files import `launch` and `launch_ros` where those packages are not installed.

Inside `ros_imports()`, `from launch.actions import ExecuteProcess` imports launch_py's class of
that name. Outside it, and if the real package can be imported, nothing changes.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from importlib.machinery import ModuleSpec
from inspect import isclass, isfunction
from types import ModuleType
from typing import TYPE_CHECKING, Any

from launch_py.near_names import describe_known

if TYPE_CHECKING:
    from importlib.abc import Loader
else:
    # The import system needs only the methods, and `importlib.abc` imports `tempfile` and more.
    Loader = object


SOURCES = "launch_py.launch_description_sources"
ANY = "typing:Any"

HOMES: dict[str, str] = {
    "launch": "launch_py",
    "launch.action": "launch_py.action",
    "launch.actions": "launch_py.actions",
    "launch.condition": "launch_py.conditions",
    "launch.conditions": "launch_py.conditions",
    "launch.descriptions": "",
    "launch.event": "launch_py.events",
    "launch.event_handler": "launch_py.event_handlers",
    "launch.event_handlers": "launch_py.event_handlers",
    "launch.events": "launch_py.events",
    "launch.events.process": "launch_py.events",
    "launch.frontend": "",
    "launch.invalid_launch_file_error": "",
    "launch.launch_context": "launch_py.launch_context",
    "launch.launch_description": "launch_py.launch_description",
    "launch.launch_description_entity": "",
    "launch.launch_description_source": SOURCES,
    "launch.launch_description_sources": SOURCES,
    "launch.launch_introspector": "",
    "launch.launch_service": "",
    "launch.logging": "",
    "launch.some_entities_type": "",
    "launch.some_substitutions_type": "",
    "launch.substitution": "launch_py.substitution",
    "launch.substitutions": "launch_py.substitutions",
    "launch.utilities": "launch_py.utilities",
    "launch_ros": "launch_py.ros",
    "launch_ros.actions": "launch_py.ros.actions",
    "launch_ros.default_launch_description": "",
    "launch_ros.descriptions": "launch_py.ros.descriptions",
    "launch_ros.event_handlers": "",
    "launch_ros.events": "",
    "launch_ros.events.lifecycle": "",
    "launch_ros.events.matchers": "",
    "launch_ros.parameter_descriptions": "launch_py.ros.parameter_descriptions",
    "launch_ros.parameters_type": "",
    "launch_ros.remap_rule_type": "",
    "launch_ros.ros_adapters": "",
    "launch_ros.substitutions": "launch_py.ros.substitutions",
    "launch_ros.utilities": "",
    "launch_xml": SOURCES,
    "launch_xml.launch_description_sources": SOURCES,
    "launch_yaml": SOURCES,
    "launch_yaml.launch_description_sources": SOURCES,
}
"""The launch_py module that has the names of each ROS module; "" if none has."""

_TYPES = {
    "SomeEntitiesType": ANY,
    "SomeEntitiesType_types_tuple": "launch_py.utilities:ENTITY_TYPES",
    "SomeSubstitutionsType": "launch_py.substitution:Text",
    "SomeSubstitutionsType_types_tuple": "launch_py.utilities:TEXT_TYPES",
}
_READERS: dict[str, str] = dict.fromkeys(
    (
        "get_launch_description_from_any_launch_file",
        "get_launch_description_from_frontend_launch_file",
        "get_launch_description_from_python_launch_file",
    ),
    f"{SOURCES}:read_launch_file",
)
_ENTITY = {"LaunchDescriptionEntity": "launch_py.events:LaunchDescriptionEntity"}
_ERROR = "launch_py.errors:LaunchFileError"
_LIFECYCLE = "launch_py.ros.lifecycle"

OTHER_NAMES: dict[str, dict[str, str]] = {
    "launch": {
        "Condition": "launch_py.conditions:Condition",
        "Event": "launch_py.events:Event",
        "EventHandler": "launch_py.event_handlers:EventHandler",
        "InvalidLaunchFileError": _ERROR,
        **_ENTITY,
        "LaunchDescriptionSource": f"{SOURCES}:LaunchDescriptionSource",
        "Substitution": "launch_py.substitution:Substitution",
        **_TYPES,
    },
    "launch.descriptions": {"Executable": "launch_py.actions.execute_process:Executable"},
    "launch.frontend": {
        "InvalidFrontendLaunchFileError": _ERROR,
        "parse_substitution": "launch_py.ros.substitution_parser:parse_substitutions",
    },
    "launch.invalid_launch_file_error": {"InvalidLaunchFileError": _ERROR},
    "launch.launch_description_entity": _ENTITY,
    "launch.launch_description_sources": {
        **_READERS,
        "InvalidFrontendLaunchFileError": _ERROR,
        "InvalidLaunchFileError": _ERROR,
        "InvalidPythonLaunchFileError": _ERROR,
    },
    "launch.logging": {"get_logger": "launch_py.utilities:get_logger"},
    "launch.some_entities_type": _TYPES,
    "launch.some_substitutions_type": _TYPES,
    "launch_ros.actions": {
        name: f"{home}:{name}"
        for home, names in {
            _LIFECYCLE: ("LifecycleNode", "LifecycleTransition"),
            "launch_py.ros.composable": ("ComposableNodeContainer", "LoadComposableNodes"),
            "launch_py.ros.actions": ("ROSTimer", "PushROSNamespace"),
        }.items()
        for name in names
    },
    "launch_ros.event_handlers": {"OnStateTransition": f"{_LIFECYCLE}:OnStateTransition"},
    "launch_ros.events": {"matches_node_name": f"{_LIFECYCLE}:matches_node_name"},
    "launch_ros.events.lifecycle": {
        name: f"{_LIFECYCLE}:{name}"
        for name in ("ChangeState", "StateTransition", "matches_node_name")
    },
    "launch_ros.events.matchers": {"matches_node_name": f"{_LIFECYCLE}:matches_node_name"},
    "launch_ros.parameters_type": dict.fromkeys(
        (
            "EvaluatedParameterValue",
            "EvaluatedParameters",
            "Parameters",
            "ParametersDict",
            "SomeParameterName",
            "SomeParameterValue",
            "SomeParameters",
            "SomeParametersDict",
        ),
        ANY,
    ),
    "launch_ros.remap_rule_type": dict.fromkeys(
        ("RemapRule", "RemapRules", "SomeRemapRule", "SomeRemapRules"), ANY
    ),
    "launch_ros.utilities": {
        name: f"launch_py.utilities:{name}"
        for name in (
            "is_namespace_absolute",
            "is_root_namespace",
            "make_namespace_absolute",
            "prefix_namespace",
        )
    },
}
"""Names that launch_py keeps in another module or calls differently."""

_RUNS_ITSELF = "`arm launch FILE` runs the description; the file need not"
_FRONTEND = "the elements of XML and YAML files are those in the manual; write a Python file"
_LOGS = "set ROS_LOG_DIR for the folder of the logs, and pass -a or -d to `arm launch` to see more"
_NO_ASYNCIO = "the launcher has no asyncio loop; OpaqueCoroutine runs a coroutine beside it"
_NO_NODE = "the launcher is no node: start a node that does it"
_NODE_DOES = "pass parameters and remappings to Node, which converts them"

NOT_HERE: dict[str, dict[str, str]] = {
    "launch": {
        "LaunchIntrospector": "`arm launch --print` shows what a file would start",
        "LaunchService": _RUNS_ITSELF,
    },
    "launch.event_handlers": {
        "OnIncludeLaunchDescription": "the launcher handles that event itself",
    },
    "launch.events.process": {
        "ProcessStdin": "processes have no standard input here",
    },
    "launch.frontend": dict.fromkeys(
        ("Entity", "Parser", "expose_action", "expose_substitution", "type_utils"), _FRONTEND
    ),
    "launch.launch_description_sources": {
        "load_python_launch_file_as_module": "include the file, or import a module of a package",
    },
    "launch.launch_introspector": {
        "LaunchIntrospector": "`arm launch --print` shows what a file would start",
    },
    "launch.launch_service": {"LaunchService": _RUNS_ITSELF},
    "launch.logging": dict.fromkeys(
        ("LaunchConfig", "get_output_loggers", "handlers", "launch_config", "reset"), _LOGS
    ),
    "launch.utilities": dict.fromkeys(
        ("AsyncSafeSignalManager", "create_future", "visit_all_entities_and_collect_futures"),
        _NO_ASYNCIO,
    ),
    "launch_ros.default_launch_description": {"ROSSpecificLaunchStartup": _RUNS_ITSELF},
    "launch_ros.ros_adapters": dict.fromkeys(
        ("ROSAdapter", "get_ros_adapter", "get_ros_node"), _NO_NODE
    ),
    "launch_ros.utilities": {
        "LifecycleEventManager": "LifecycleNode does it",
        **dict.fromkeys(
            (
                "add_node_name",
                "evaluate_parameters",
                "evaluate_parameters_dict",
                "get_node_name_count",
                "normalize_parameters",
                "normalize_parameters_dict",
                "normalize_remap_rule",
                "normalize_remap_rules",
                "to_parameters_list",
            ),
            _NODE_DOES,
        ),
    },
}
"""Names that can be imported, as many files import more than they use, but not used; and why."""


class MissingRosNameError(ImportError):
    """A launch file imports or uses a name that does not exist here; the message says what does."""


class _Absent(type):
    """The class of names that can only be imported: whatever is done with one tells why."""

    def __call__(cls, *_args: object, **_options: object) -> Any:
        raise cls.error()

    def __getattr__(cls, name: str) -> Any:
        raise AttributeError(name) if name.startswith("__") else cls.error()

    def __setattr__(cls, name: str, value: object) -> None:
        raise cls.error()

    def error(cls) -> MissingRosNameError:
        """Return the error that names the reason."""
        return MissingRosNameError(f"{cls.__module__} has no {cls.__name__!r} here; {cls.__doc__}")


@contextmanager
def ros_imports() -> Iterator[None]:
    """Make the names of `launch` and `launch_ros` importable in this context.

    A package that is really installed takes precedence; each package is looked up by itself.
    """
    finder = _Finder()
    sys.meta_path.insert(0, finder)
    try:
        yield
    finally:
        sys.meta_path.remove(finder)
        for name in finder.made:
            sys.modules.pop(name, None)


class _Finder(Loader):
    """Finds and loads the modules of HOMES, unless the package is installed."""

    def __init__(self) -> None:
        self.made: list[str] = []

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the spec of a ROS module, None for any other module."""
        top, _, rest = fullname.partition(".")
        if top not in HOMES or (not rest and self._is_installed(top)):
            return None
        if rest and top not in self.made:
            return None  # The real package finds its own modules.
        above = fullname.rpartition(".")[0]
        if fullname not in HOMES and (above not in HOMES or above == top):
            raise _missing_module(fullname)
        return ModuleSpec(fullname, self, is_package=True)

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """Return the module with launch_py's names."""
        home = spec.name
        if home not in HOMES:
            # A module such as launch.actions.timer_action has the names of its parent.
            home = home.rpartition(".")[0]
        self.made.append(spec.name)
        return _RosModule(spec.name, home)

    def exec_module(self, module: ModuleType) -> None:
        """Do nothing: names are looked up on first use."""

    def _is_installed(self, package: str) -> bool:
        for finder in sys.meta_path:
            find = getattr(finder, "find_spec", None)
            if isinstance(finder, _Finder) or find is None:
                continue
            spec = find(package, None)
            # A plain folder launch/ on the path is a namespace package, which has no origin.
            if spec is not None:
                return spec.origin is not None
        return False


class _RosModule(ModuleType):
    """Stands in for a ROS module, with the names that exist here."""

    def __init__(self, name: str, home: str) -> None:
        super().__init__(name, f"The names of {home} that launch_py has.")
        self.__home = home

    def __getattr__(self, name: str) -> Any:
        if name == "__all__":
            return _names(self.__home)
        if name.startswith("__"):
            raise AttributeError(name)
        if f"{self.__name__}.{name}" in HOMES:
            return import_module(f"{self.__name__}.{name}")
        reason = NOT_HERE.get(self.__home, {}).get(name)
        if reason is not None:
            return _Absent(name, (), {"__module__": self.__name__, "__doc__": reason})
        if name not in _names(self.__home):
            raise _missing_name(self.__name__, name, _names(self.__home))
        return _find(self.__home, name)


def _names(home: str) -> list[str]:
    """Return the names that a ROS module has here, sorted."""
    found = {*OTHER_NAMES.get(home, ()), *NOT_HERE.get(home, ())}
    if HOMES[home]:
        module = import_module(HOMES[home])
        found.update(getattr(module, "__all__", None) or _own_names(module))
    return sorted(found)


def _own_names(module: ModuleType) -> list[str]:
    return [
        name
        for name, value in vars(module).items()
        if (isclass(value) or isfunction(value))
        and value.__module__ == module.__name__
        and not name.startswith("_")
    ]


def _find(home: str, name: str) -> Any:
    where, _, there = OTHER_NAMES.get(home, {}).get(name, f"{HOMES[home]}:{name}").partition(":")
    return getattr(import_module(where), there)


def _missing_name(module: str, name: str, known: list[str]) -> MissingRosNameError:
    near = describe_known(name, known)
    reason = near if near.startswith("did you mean") else f"it has {', '.join(known)}"
    return MissingRosNameError(f"{module} has no {name!r} here; {reason}")


def _missing_module(name: str) -> MissingRosNameError:
    near = describe_known(name, HOMES)
    reason = near if near.startswith("did you mean") else f"there are {', '.join(sorted(HOMES))}"
    return MissingRosNameError(f"there is no module {name!r} here; {reason}")
