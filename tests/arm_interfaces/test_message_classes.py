"""Every class has the recorded fields and constants, and survives the way over the wire."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_generator_type_description import (
    calculate_type_hash,
    extract_full_type_description,
    serialize_individual_type_description,
)
from rosidl_parser.definition import AbstractSequence, Array, BasicType, Member, NamespacedType

EXPECTED_CONSTANTS: dict[str, dict[str, Any]] = yaml.safe_load(
    (Path(__file__).parent / "expected_constants.yaml").read_bytes()
)

PARTS = {
    "srv": {"request_message": "Request", "response_message": "Response", "event_message": "Event"},
    "action": {
        "goal": "Goal",
        "result": "Result",
        "feedback": "Feedback",
        "send_goal_service": "SendGoalService",
        "get_result_service": "GetResultService",
        "feedback_message": "FeedbackMessage",
    },
}
"""The members of services and actions as structures, and the classes that these are."""
EMPTY = {"structure_needs_at_least_one_member": BasicType("uint8")}


@pytest.fixture
def parts(recorded, load_type) -> dict[str, Any]:
    """The messages of a package by name, those inside services and actions too."""
    classes = {name: load_type(name) for name in recorded}
    inside = {
        f"{name}_{part}": getattr(cls, part)
        for name, cls in classes.items()
        for part in ("Request", "Response", "Goal", "Result", "Feedback")
        if hasattr(cls, part)
    }
    return inside | {name: cls for name, cls in classes.items() if "/msg/" in name}


@pytest.fixture
def hash_of(load_type) -> Callable[[str], str]:
    """Return a function that makes a type's hash from the fields of its Python classes."""
    known: dict[str, dict[str, Any]] = {}

    def describe(name: str, cls: Any) -> None:
        *namespaces, short = name.split("/")
        inside: dict[str, Any] = {}
        if hasattr(cls, "SLOT_TYPES"):
            fields = dict(zip(cls.get_fields_and_field_types(), cls.SLOT_TYPES, strict=True))
        else:
            fields = {}
            for field, part in PARTS["action" if hasattr(cls, "Impl") else "srv"].items():
                of = part.removesuffix("Service")
                fields[field] = NamespacedType(namespaces, f"{short}_{of}")
                inside[f"{name}_{of}"] = getattr(cls if hasattr(cls, part) else cls.Impl, part)
        known[name] = serialize_individual_type_description(
            NamespacedType(namespaces, short),
            [Member(kind, field) for field, kind in (fields or EMPTY).items()],
        )
        for field in known[name]["fields"]:
            nested = field["type"]["nested_type_name"]
            if nested and nested not in known:
                describe(nested, inside.get(nested) or load_type(nested))

    def made(name: str) -> str:
        describe(name, load_type(name))
        return calculate_type_hash(extract_full_type_description(name, known))

    return made


def spelt(kind: Any) -> str:
    """Spell a field's type as the generated class does."""
    if isinstance(kind, AbstractSequence):
        return f"sequence<{spelt(kind.value_type)}>"
    if isinstance(kind, Array):
        return f"{spelt(kind.value_type)}[{kind.size}]"
    if isinstance(kind, NamespacedType):
        return f"{kind.namespaces[0]}/{kind.name}"
    return kind.typename if isinstance(kind, BasicType) else "string"


def test_the_fields_of_its_classes_make_a_types_hash(recorded, hash_of):
    assert {name: hash_of(name) for name in recorded} == recorded


def test_the_types_of_fields_are_spelt_as_they_are(parts):
    found = {name: list(cls.get_fields_and_field_types().values()) for name, cls in parts.items()}
    assert found == {name: list(map(spelt, cls.SLOT_TYPES)) for name, cls in parts.items()}


def test_instances_have_every_field(parts):
    missing = [
        f"{name}.{field}"
        for name, cls in parts.items()
        for message in (cls(),)
        for field in cls.get_fields_and_field_types()
        if getattr(message, field, None) is None
    ]
    assert missing == []


def test_constants_have_their_values(parts):
    package = next(iter(parts)).partition("/")[0]
    wanted = {n: c for n, c in EXPECTED_CONSTANTS.items() if n.startswith(f"{package}/")}
    found = {
        name: {constant: _number(getattr(parts[name], constant)) for constant in constants}
        for name, constants in wanted.items()
    }
    assert found == wanted


def test_default_messages_survive_serialisation(parts):
    for name, cls in parts.items():
        message = cls()
        assert deserialize_message(serialize_message(message), cls) == message, name


def test_a_motion_primitive_is_of_unknown_type_at_first(load_type):
    primitive = load_type("control_msgs/msg/MotionPrimitive")
    assert primitive().type == primitive.UNKNOWN == -1


def test_one_step_is_the_default(load_type):
    assert load_type("simulation_interfaces/srv/StepSimulation").Request().steps == 1


@pytest.mark.parametrize(
    ("type_name_", "fields"),
    [
        ("control_msgs/msg/PidState", {"p_term": 1.5, "output": -2.25}),
        ("control_msgs/msg/InterfaceValue", {"interface_names": ["a"], "values": [0.5]}),
        ("control_msgs/msg/Keys", {"keys": ["a", "b"]}),
        ("pal_statistics_msgs/msg/StatisticsValues", {"values": [0.5, -1.0], "names_version": 7}),
        ("simulation_interfaces/msg/SimulatorFeatures", {"features": [0, 31, 50]}),
        ("controller_manager_msgs/msg/HardwareInterface", {"name": "ü", "is_claimed": True}),
    ],
)
def test_values_survive_serialisation(load_type, type_name_, fields):
    cls = load_type(type_name_)
    message = cls(**fields)
    copy = deserialize_message(serialize_message(message), cls)
    assert {name: _plain(getattr(copy, name)) for name in fields} == fields


def _number(value: Any) -> Any:
    """Turn a byte into its number."""
    return value[0] if isinstance(value, bytes) else value


def _plain(value: Any) -> Any:
    """Turn an array into a list."""
    return list(value) if hasattr(value, "typecode") else value
