"""robot_state_publisher's parameters."""

import pytest

from arm_description import SettingsError
from arm_description.publishers.settings import StatePublisherSettings

URDF = "<robot/>"


def test_the_defaults_are_upstreams():
    settings = StatePublisherSettings.from_parameters({"robot_description": URDF})
    assert settings == StatePublisherSettings(robot_description=URDF)
    assert (settings.publish_frequency_hz, settings.frame_prefix) == (20.0, "")
    assert settings.ignore_timestamp is False


def test_every_value_is_taken():
    values = {
        "robot_description": URDF,
        "publish_frequency": 30,
        "frame_prefix": "left/",
        "ignore_timestamp": True,
    }
    assert StatePublisherSettings.from_parameters(values) == StatePublisherSettings(
        robot_description=URDF,
        publish_frequency_hz=30.0,
        frame_prefix="left/",
        ignore_timestamp=True,
    )


@pytest.mark.parametrize("frequency", [0, 0.0, 1000.0])
def test_the_frequency_may_be_at_its_bounds(frequency):
    values = {"robot_description": URDF, "publish_frequency": frequency}
    assert StatePublisherSettings.from_parameters(values).publish_frequency_hz == frequency


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("robot_description", "", "Empty URDF is not allowed"),
        ("robot_description", " \n", "Empty URDF is not allowed"),
        ("robot_description", 5, "robot_description must be a text, not 5"),
        ("publish_frequency", -1.0, "must be between 0 and 1000 Hz, not -1"),
        ("publish_frequency", 1001, "must be between 0 and 1000 Hz, not 1001"),
        ("publish_frequency", float("nan"), "must be between 0 and 1000 Hz, not nan"),
        ("publish_frequency", "20", "publish_frequency must be between 0 and 1000 Hz, not '20'"),
        ("publish_frequency", True, "publish_frequency must be between 0 and 1000 Hz, not True"),
        ("frame_prefix", 1, "frame_prefix must be a text, not 1"),
        ("ignore_timestamp", "yes", "ignore_timestamp must be true or false, not 'yes'"),
        ("ignore_timestamp", None, "ignore_timestamp must be true or false, not None"),
    ],
)
def test_a_value_that_cannot_be_used_is_refused(name, value, message):
    with pytest.raises(SettingsError, match=message):
        StatePublisherSettings.from_parameters({"robot_description": URDF, name: value})
