"""Where launch_py has the names of ROS 2's `launch` and `launch_ros`, and which it lacks."""

from __future__ import annotations

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
    "launch.launch_description_entity": "launch_py.launch_description_entity",
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
_ERROR = "launch_py.errors:LaunchFileError"
_LIFECYCLE = "launch_py.ros.lifecycle"

OTHER_NAMES: dict[str, dict[str, str]] = {
    "launch": {
        "Condition": "launch_py.conditions:Condition",
        "Event": "launch_py.events:Event",
        "EventHandler": "launch_py.event_handlers:EventHandler",
        "InvalidLaunchFileError": _ERROR,
        "LaunchDescriptionEntity": "launch_py.launch_description_entity:LaunchDescriptionEntity",
        "LaunchDescriptionSource": f"{SOURCES}:LaunchDescriptionSource",
        "Substitution": "launch_py.substitution:Substitution",
        **_TYPES,
    },
    "launch.descriptions": {"Executable": "launch_py.actions.execute_local:Executable"},
    "launch.frontend": {
        "InvalidFrontendLaunchFileError": _ERROR,
        "parse_substitution": "launch_py.ros.substitution_parser:parse_substitutions",
    },
    "launch.invalid_launch_file_error": {"InvalidLaunchFileError": _ERROR},
    "launch.launch_description_sources": {
        **_READERS,
        "InvalidFrontendLaunchFileError": _ERROR,
        "InvalidLaunchFileError": _ERROR,
        "InvalidPythonLaunchFileError": _ERROR,
    },
    "launch.logging": {"get_logger": "launch_py.messages:get_logger"},
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
