"""Every class has the recorded fields and constants, and survives the way over the wire."""

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from rclpy.serialization import deserialize_message, serialize_message

PYTHON_NAMES = {"bool": "boolean", "byte": "octet", "float32": "float", "float64": "double"}


def message_parts(cls: type, expected: dict[str, Any]) -> Iterator[tuple[type, dict[str, Any]]]:
    """Pair the class of a message, or the classes inside a service or action, with its record."""
    for part, record in expected.items():
        if part != "hash":
            yield cls if part == "Message" else getattr(cls, part), record


def python_field_type(field_type: str, package: str) -> str:
    """Spell a field's type as the generated class does."""
    if field_type.endswith("[]"):
        return f"sequence<{python_field_type(field_type.removesuffix('[]'), package)}>"
    if field_type[0].isupper():
        return f"{package}/{field_type}"
    return PYTHON_NAMES.get(field_type, field_type)


def test_fields_are_in_order(
    type_name: str, expected: dict[str, Any], load_type: Callable[[str], type]
) -> None:
    package = type_name.split("/")[0]
    for cls, record in message_parts(load_type(type_name), expected):
        wanted = {
            name: python_field_type(field_type, package)
            for name, field_type in record.get("fields", {}).items()
        }
        found = cls.get_fields_and_field_types()
        assert list(found.items()) == list(wanted.items())


def test_instance_has_every_field(
    type_name: str, expected: dict[str, Any], load_type: Callable[[str], type]
) -> None:
    for cls, record in message_parts(load_type(type_name), expected):
        message = cls()
        for name in record.get("fields", {}):
            assert getattr(message, name) is not None


def test_constants_have_their_values(
    type_name: str, expected: dict[str, Any], load_type: Callable[[str], type]
) -> None:
    for cls, record in message_parts(load_type(type_name), expected):
        constants = record.get("constants", {})
        assert {name: _number(getattr(cls, name)) for name in constants} == constants


def test_default_message_survives_serialisation(
    type_name: str, expected: dict[str, Any], load_type: Callable[[str], type]
) -> None:
    for cls, _ in message_parts(load_type(type_name), expected):
        message = cls()
        assert deserialize_message(serialize_message(message), cls) == message


def test_a_motion_primitive_is_of_unknown_type_at_first(load_type: Callable[[str], type]) -> None:
    primitive = load_type("control_msgs/msg/MotionPrimitive")
    assert primitive().type == primitive.UNKNOWN == -1


def test_one_step_is_the_default(load_type: Callable[[str], type]) -> None:
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
def test_values_survive_serialisation(
    load_type: Callable[[str], type], type_name_: str, fields: dict[str, Any]
) -> None:
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
