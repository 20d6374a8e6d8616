"""Types found in the tables and in installed packages."""

from importlib.metadata import EntryPoint

import pytest

from arm_control import Controller
from arm_control.controllers.forward_command.controller import JointGroupPositionController
from arm_control.errors import RegistryError
from arm_control.hardware.info import HardwareInfo
from arm_control.hardware.mock_components import GenericSystem
from arm_control.manager.registry import (
    controller_class,
    controller_types,
    create_hardware,
    is_chainable,
    load_object,
)


@pytest.fixture
def installed(monkeypatch) -> list[EntryPoint]:
    """Return the entry points of all installed packages, for a test to add to."""
    points: list[EntryPoint] = []
    monkeypatch.setattr(
        "importlib.metadata.entry_points",
        lambda group: tuple(point for point in points if point.group == group),
    )
    return points


def test_built_in_types_are_found():
    found = controller_class("position_controllers/JointGroupPositionController")
    assert found is JointGroupPositionController


@pytest.mark.parametrize("type_name", controller_types())
def test_every_type_is_a_controller_and_its_adapter_exists(type_name):
    found = controller_class(type_name)
    assert issubclass(found, Controller)
    is_own = found.__module__.startswith("arm_control.")
    assert found.adapter or not is_own
    assert not found.adapter or load_object(found.adapter)


def test_types_are_listed_in_order():
    types = controller_types()
    assert list(types) == sorted(types)
    assert "joint_state_broadcaster/JointStateBroadcaster" in types


def test_a_type_knows_whether_it_can_be_chained(installed):
    assert is_chainable("pid_controller/PidController")
    assert not is_chainable("joint_state_broadcaster/JointStateBroadcaster")
    installed.append(EntryPoint("x/Broken", "nowhere:Thing", "arm_control.controllers"))
    assert not is_chainable("x/Broken")


def test_an_installed_package_adds_a_type(installed):
    path = "arm_control.controllers.forward_command.controller:JointGroupPositionController"
    installed.append(EntryPoint("mine/PdController", path, "arm_control.controllers"))
    assert controller_class("mine/PdController") is JointGroupPositionController
    assert "mine/PdController" in controller_types()


def test_an_unknown_type_is_refused_with_those_there_are(installed):
    with pytest.raises(RegistryError, match=r"no controller type 'x/Y'; known: .*position_contr"):
        controller_class("x/Y")


def test_a_type_that_is_not_a_controller_is_refused(installed):
    installed.append(EntryPoint("x/Y", "collections:OrderedDict", "arm_control.controllers"))
    with pytest.raises(RegistryError, match=r"does not derive from arm_control\.Controller"):
        controller_class("x/Y")


@pytest.mark.parametrize("path", ["nowhere:Thing", "arm_control.manager.registry:Nothing"])
def test_a_failed_import_is_reported_with_the_reason(installed, path):
    installed.append(EntryPoint("x/Y", path, "arm_control.controllers"))
    with pytest.raises(RegistryError, match=f"cannot import '{path}': .*Error"):
        controller_class("x/Y")


def test_hardware_is_made_by_its_plugin():
    info = HardwareInfo("H", "system", "mock_components/GenericSystem")
    assert isinstance(create_hardware(info), GenericSystem)


def test_an_unknown_plugin_is_refused(installed):
    info = HardwareInfo("H", "system", "x/Y")
    with pytest.raises(RegistryError, match=r"no hardware plugin 'x/Y'; known: .*mock_components/"):
        create_hardware(info)


def test_hardware_that_cannot_be_created_is_reported_with_the_reason(installed):
    installed.append(EntryPoint("x/Y", "builtins:int", "arm_control.hardware"))
    with pytest.raises(
        RegistryError, match="component 'H' cannot be created by 'x/Y': TypeError: "
    ):
        create_hardware(HardwareInfo("H", "system", "x/Y"))
