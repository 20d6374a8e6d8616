"""joint_state_publisher's parameters."""

import pytest

from arm_description import SettingsError
from arm_description.publishers.settings import JointPublisherSettings
from arm_description.urdf.robot import Mimic


def read(**parameters) -> JointPublisherSettings:
    return JointPublisherSettings.from_parameters(
        {name.replace("__", "."): value for name, value in parameters.items()}
    )


def test_the_defaults_are_upstreams():
    assert read() == JointPublisherSettings(
        rate_hz=10,
        source_list=(),
        publish_default_positions=True,
        publish_default_velocities=False,
        publish_default_efforts=False,
        use_mimic_tags=True,
        use_smallest_joint_limits=True,
        delta=0.0,
        zeros={},
        dependent_joints={},
    )


def test_every_value_is_taken():
    settings = read(
        rate=50,
        source_list=["a", "/b"],
        publish_default_positions=False,
        publish_default_velocities=True,
        publish_default_efforts=True,
        use_mimic_tags=False,
        use_smallest_joint_limits=False,
        delta=1,
    )
    assert settings == JointPublisherSettings(
        rate_hz=50,
        source_list=("a", "/b"),
        publish_default_positions=False,
        publish_default_velocities=True,
        publish_default_efforts=True,
        use_mimic_tags=False,
        use_smallest_joint_limits=False,
        delta=1.0,
    )


def test_zeros_by_joint_a_name_may_hold_dots():
    assert read(zeros__j0=1, zeros__a__b=0.5).zeros == {"j0": 1.0, "a.b": 0.5}


def test_dependent_joints_by_joint():
    settings = read(
        dependent_joints__j1__parent="j0",
        dependent_joints__j1__factor=-2,
        dependent_joints__j1__offset=0.5,
        dependent_joints__j2__parent="j1",
    )
    assert settings.dependent_joints == {"j1": Mimic("j0", -2.0, 0.5), "j2": Mimic("j1", 1.0, 0.0)}


def test_parameters_of_others_are_ignored():
    assert read(use_sim_time=True, qos_overrides__x="y") == JointPublisherSettings()


def test_an_empty_list_of_sources_may_come_as_nothing():
    assert read(source_list=None).source_list == ()


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("rate", 0, "rate must be an integer from 1 to 10000"),
        ("rate", 10.0, r"rate must be an integer from 1 to 10000 \(Hz\), not 10.0"),
        ("rate", True, "rate must be an integer"),
        ("source_list", "a", "source_list must be a list of topics, not 'a'"),
        ("source_list", [1], "source_list must be a list of topics"),
        ("source_list", [""], "source_list must be a list of topics"),
        ("publish_default_positions", 1, "publish_default_positions must be true or false, not 1"),
        ("use_mimic_tags", "no", "use_mimic_tags must be true or false"),
        ("delta", "1", "delta must be a finite number, not '1'"),
        ("delta", float("inf"), "delta must be a finite number, not inf"),
        ("zeros__j0", float("nan"), "zeros.j0 must be a finite number, not nan"),
        ("zeros__j0", True, "zeros.j0 must be a finite number, not True"),
        ("dependent_joints__j1__factor", 2.0, "j1.parent must be the name of a joint"),
        ("dependent_joints__j1__parent", 3, "j1.parent must be the name of a joint, not 3"),
        ("dependent_joints__j1__foo", 1, "a dependent joint has parent, factor and offset"),
        ("dependent_joints__parent", "j0", "a dependent joint has parent, factor and offset"),
    ],
)
def test_a_value_that_cannot_be_used_is_refused(name, value, message):
    with pytest.raises(SettingsError, match=message):
        read(**{name: value})


@pytest.mark.parametrize("key", ["factor", "offset"])
def test_a_dependence_that_is_not_a_number_is_refused(key):
    with pytest.raises(SettingsError, match=rf"dependent_joints\.j1\.{key} must be a finite"):
        read(**{"dependent_joints__j1__parent": "j0", f"dependent_joints__j1__{key}": "x"})
