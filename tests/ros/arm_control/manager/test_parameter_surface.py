"""The parameters of every controller, against those of ROS 2 Jazzy, over real ROS."""

from pathlib import Path
from typing import Any

import pytest
import yaml
from rcl_interfaces.srv import DescribeParameters, ListParameters

SURFACE: dict[str, Any] = yaml.safe_load(
    (Path(__file__).parent / "parameter_surface.yaml").read_text(encoding="utf-8")
)
EVERY_CONTROLLER = {"is_async": "bool", "thread_priority": "int", "update_rate": "int"}
EVERY_NODE = {"use_sim_time": "bool", "start_type_description_service": "bool read_only"}
TYPES = {1: "bool", 2: "int", 3: "double", 4: "string", 8: "double[]", 9: "string[]"}


def name_of(type_name: str) -> str:
    return type_name.replace("/", "_").lower()


@pytest.fixture(scope="module")
def manager(run_manager):
    """Return a manager that knows a controller of each type."""
    parameters: dict[str, Any] = {
        "controller_manager": {
            "ros__parameters": {name_of(type_): {"type": type_} for type_ in SURFACE}
        }
    }
    for type_name, record in SURFACE.items():
        parameters[name_of(type_name)] = {"ros__parameters": record.get("given", {})}
    return run_manager(parameters=parameters)


@pytest.fixture
def describe(client):
    """Return a function that returns the descriptors of all parameters of a node by name."""

    def describe_(node: str, *names: str) -> dict[str, Any]:
        if not names:
            names = client.call(
                ListParameters, f"{node}/list_parameters", ListParameters.Request()
            ).result.names
        request = DescribeParameters.Request(names=list(names))
        found = client.call(DescribeParameters, f"{node}/describe_parameters", request).descriptors
        return {descriptor.name: descriptor for descriptor in found}

    return describe_


@pytest.mark.parametrize("type_name", SURFACE)
def test_names_types_and_what_is_read_only(control, describe, type_name):
    assert control.load(name_of(type_name))
    record = SURFACE[type_name]
    found = {
        name: f"{TYPES[descriptor.type]}{' read_only' if descriptor.read_only else ''}"
        for name, descriptor in describe(f"/{name_of(type_name)}").items()
        if not name.startswith("qos_overrides.")
    }
    expected = {**record["parameters"], **record.get("own", {}), **EVERY_CONTROLLER, **EVERY_NODE}
    assert found == expected


def test_bounds_are_ranges(control, describe):
    trajectory = name_of("joint_trajectory_controller/JointTrajectoryController")
    assert control.load(trajectory)
    found = describe(f"/{trajectory}", "constraints.goal_time", "interpolation_method")
    (bounds,) = found["constraints.goal_time"].floating_point_range
    assert (bounds.from_value, bounds.to_value) == (0.0, float("inf"))
    assert found["constraints.goal_time"].additional_constraints == "at least 0"
    assert found["interpolation_method"].additional_constraints == "one of splines, none"

    drive = name_of("diff_drive_controller/DiffDriveController")
    assert control.load(drive)
    found = describe(f"/{drive}", "velocity_rolling_window_size")
    (bounds,) = found["velocity_rolling_window_size"].integer_range
    assert (bounds.from_value, bounds.to_value) == (1, 2**63 - 1)


def test_the_type_of_a_controller_is_described_as_a_string(manager, describe):
    name = f"{name_of('pid_controller/PidController')}.type"
    assert TYPES[describe("/controller_manager", name)[name].type] == "string"


def test_a_frame_changes_with_the_next_configuration(control, set_parameter, get_parameter):
    drive = name_of("diff_drive_controller/DiffDriveController")
    assert control.load(drive)
    # The names of the wheels come one after the other, and no robot can drive in between.
    for name, value in {
        "left_wheel_names": ["j0", "j1"],
        "right_wheel_names": ["j2", "j3"],
        "wheel_separation": 0.4,
        "wheel_radius": 0.1,
        "publish_limited_velocity": True,
    }.items():
        result = set_parameter(f"/{drive}", name, value)
        assert (result.successful, result.reason) == (True, "")
    assert control.configure(drive)
    result = set_parameter(f"/{drive}", "left_wheel_names", ["j0"])
    assert result.successful
    assert result.reason == "it takes effect when the controller is configured again"
    assert get_parameter(f"/{drive}", "left_wheel_names") == ["j0"]
    claimed = {c.name: c.required_command_interfaces for c in control.list()}[drive]
    assert "j1/velocity" in claimed
    # A limit counts at once, whatever else is waiting.
    assert set_parameter(f"/{drive}", "linear.x.max_velocity", 0.5).reason == ""
    assert not control.configure(drive)
    assert set_parameter(f"/{drive}", "right_wheel_names", ["j3"]).successful
    assert control.configure(drive)
    claimed = {c.name: c.required_command_interfaces for c in control.list()}[drive]
    assert list(claimed) == ["j0/velocity", "j3/velocity"]


def test_a_value_out_of_bounds_is_refused_with_what_it_must_be(control, set_parameter):
    drive = name_of("diff_drive_controller/DiffDriveController")
    assert control.load(drive)
    result = set_parameter(f"/{drive}", "wheel_radius", -1.0)
    assert not result.successful
    assert result.reason == "parameter 'wheel_radius' must be above 0, but is -1.0"
