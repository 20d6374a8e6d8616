"""One declaration gives a setting's attribute, parameter, launch argument and help."""

from array import array
from dataclasses import dataclass

import pytest

from arm_gazebo.run.settings import RobotSettings, SimulationSettings, simulation_settings
from arm_node.parameter_values import NumberReader, ParameterValueError, read_numbers, read_words
from arm_node.setting import given_values, read_settings, setting, settings_of

URDF = "<robot name='r'><link name='l'/></robot>"
_read_share = NumberReader("a number from 0 to 1", least=0.0, most=1.0)


def _nonempty(value: object) -> str:
    if value == "":
        raise ParameterValueError("is empty")
    return str(value)


@dataclass(frozen=True, slots=True, kw_only=True)
class Base:
    step_s: float | None = setting(
        0.0, "step; 0 for any", unit="s", name="step", adapt=lambda step_s: step_s or None
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Settings(Base):
    owner: str
    text: str = setting("", "a text", _nonempty)
    share: float = setting(0.5, "a share", _read_share, changes=True)
    names: tuple[str, ...] = setting((), "names", read_words)
    place: tuple[float, ...] = setting(array("d"), "a place", read_numbers)
    flag: bool = setting(True, "a flag")
    kind: str = setting("a", "a kind", choices=("a", "b"), launches=False)


def read(prefix: str = "", **values: object) -> Settings:
    return read_settings(Settings, given_values(values), prefix, owner="me")


def test_settings_are_read_by_their_parameter_names_and_adapted():
    found = read(step=0.01, text="x", names="a, b", place="[1, 2.5]")

    assert found == Settings(owner="me", text="x", step_s=0.01, names=("a", "b"), place=(1, 2.5))


def test_defaults_are_read_and_adapted_like_given_values():
    assert Settings(owner="me", text="x") == read(text="x")
    assert Settings(owner="me", text="x").step_s is None


def test_a_default_that_the_check_refuses_has_to_be_given():
    with pytest.raises(TypeError, match="text"):
        Settings(owner="me")  # pyright: ignore[reportCallIssue]
    with pytest.raises(ParameterValueError, match="text is empty"):
        read()


def test_a_prefix_selects_one_of_several():
    values = {"left.text": "x", "right.text": "y"}
    right = read_settings(Settings, given_values(values), "right.", owner="me")

    assert right.text == "y"


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"share": 2.0}, "share must be a number from 0 to 1, not 2.0"),
        ({"flag": "yes"}, "flag must be true or false, not 'yes'"),
        ({"kind": "c"}, "kind must be one of a, b, not 'c'"),
        ({"step": "x"}, "step must be a finite number, not 'x'"),
    ],
)
def test_an_invalid_value_is_named_with_what_is_valid(values, sentence):
    with pytest.raises(ParameterValueError) as error:
        read(text="x", **values)
    assert str(error.value) == sentence


def test_a_launch_argument_has_default_choices_and_help_with_the_unit():
    by_name = {each.name: each for each in settings_of(Settings)}

    assert list(by_name) == ["step", "text", "share", "names", "place", "flag", "kind"]
    assert by_name["step"].launch_argument == {
        "default_value": "0.0",
        "description": "step, in s; 0 for any",
        "choices": None,
    }
    assert by_name["flag"].launch_argument["default_value"] == "true"
    assert by_name["names"].launch_argument["default_value"] == ""
    assert by_name["place"].launch_argument["default_value"] == ""
    assert by_name["kind"].choices == ("a", "b")
    assert [name for name, each in by_name.items() if each.changes] == ["share"]
    assert [name for name, each in by_name.items() if not each.launches] == ["kind"]


def test_each_field_of_the_simulation_and_its_robots_is_declared():
    """A field without `setting` would be neither a parameter nor in the manual."""
    undeclared = {
        cls: {*cls.__dataclass_fields__} - {each.attribute for each in settings_of(cls)}
        for cls in (SimulationSettings, RobotSettings)
    }
    assert undeclared == {SimulationSettings: {"robots"}, RobotSettings: {"namespace"}}


def test_the_simulation_is_read_from_values_by_name():
    found = simulation_settings(given_values({"robot_description": URDF, "physics_step": 0.002}))

    assert found.physics_step_s == 0.002
    assert found.hold_joints is True
    assert (found.world_limit.mb, found.spawn_limit.mb) == (1000.0, 100.0)
    assert found.robots == (RobotSettings(namespace="", robot_description=URDF),)
