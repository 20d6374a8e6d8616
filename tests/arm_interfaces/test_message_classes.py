"""Every class has the recorded fields and constants, and survives the way over the wire."""

from typing import Any

import pytest
from rclpy.serialization import deserialize_message, serialize_message

PYTHON_NAMES = {"bool": "boolean", "byte": "octet", "float32": "float", "float64": "double"}


Recorded = dict[str, dict[str, Any]]
Parts = list[tuple[str, type, dict[str, Any]]]


@pytest.fixture
def parts(recorded, load_type) -> Parts:
    """Name the messages of a package, those inside services and actions too, with their record."""
    return [
        (f"{type_name}.{part}", cls if part == "Message" else getattr(cls, part), record)
        for type_name, of in recorded.items()
        for cls in (load_type(type_name),)
        for part, record in of.items()
        if part != "hash"
    ]


def python_field_type(field_type: str, package: str) -> str:
    """Spell a field's type as the generated class does."""
    if field_type.endswith("[]"):
        return f"sequence<{python_field_type(field_type.removesuffix('[]'), package)}>"
    if field_type[0].isupper():
        return f"{package}/{field_type}"
    return PYTHON_NAMES.get(field_type, field_type)


def test_fields_are_in_order(parts):
    wanted = {
        name: [
            (field, python_field_type(kind, name.split("/")[0]))
            for field, kind in record.get("fields", {}).items()
        ]
        for name, _, record in parts
    }
    found = {name: list(cls.get_fields_and_field_types().items()) for name, cls, _ in parts}
    assert found == wanted


def test_instances_have_every_field(parts):
    missing = [
        f"{name}.{field}"
        for name, cls, record in parts
        for message in (cls(),)
        for field in record.get("fields", {})
        if getattr(message, field, None) is None
    ]
    assert missing == []


def test_constants_have_their_values(parts):
    wanted = {name: record.get("constants", {}) for name, _, record in parts}
    found = {
        name: {constant: _number(getattr(cls, constant)) for constant in wanted[name]}
        for name, cls, _ in parts
    }
    assert found == wanted


def test_default_messages_survive_serialisation(parts):
    for name, cls, _ in parts:
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
