"""The arguments of a simulation: fields of one dataclass, with the settings of the physics."""

import inspect

import pytest

from arm_gazebo.run.settings import PhysicsSettings
from arm_node.setting import settings_of
from arm_sim import CallError, Simulation


def test_each_setting_of_the_physics_is_a_keyword_with_its_default_and_its_help():
    keywords = inspect.signature(Simulation).parameters
    for each in settings_of(PhysicsSettings):
        keyword = keywords[each.attribute]
        assert keyword.kind is inspect.Parameter.KEYWORD_ONLY
        assert keyword.default == each.adapt(each.read(each.default))
        assert f"{each.attribute}: {each.about}." in inspect.getdoc(Simulation)


def test_the_keywords_are_those_of_earlier_versions():
    assert set(inspect.signature(Simulation).parameters) == {
        "description", "world", "controllers", "arguments", "spawn", "seed", "base", "pose",
        "package_path", "hold_joints", "position_proportional_gain", "physics_step_s",
        "self_collide", "strict", "render_backend", "record",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("arguments", "keywords", "sentence"),
    [
        (
            (),
            {"hold_joint": False},
            "Simulation() got an unexpected keyword argument 'hold_joint'; "
            "did you mean 'hold_joints'?",
        ),
        (
            ("arm", "empty"),
            {},
            "Simulation() takes from 1 to 2 positional arguments but 3 were given",
        ),
    ],
)
def test_arguments_that_do_not_fit_are_refused(arguments, keywords, sentence):
    with pytest.raises(TypeError) as raised:
        Simulation(*arguments, **keywords)
    assert isinstance(raised.value, CallError)
    assert str(raised.value) == sentence
