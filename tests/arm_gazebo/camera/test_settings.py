"""Settings of a camera process as text."""

import pytest

from arm_gazebo.camera.settings import CameraSettings
from arm_gazebo.errors import CameraError
from arm_gazebo.sensors.camera import CameraSensor

SENSOR = CameraSensor("c", "l", "f", image_topics=("a", "b"), info_topics=("i",), rpy=(0, 1, 2))


def test_settings_survive_as_text():
    settings = CameraSettings((SENSOR,), seed=-3, backend="egl", excluded=("osmesa",))
    assert CameraSettings.from_json(settings.to_json()) == settings


@pytest.mark.parametrize(
    "text", ["", "[]", "{}", '{"cameras":[],"excluded":[],"colour":1}', '{"cameras":[{}]}']
)
def test_other_text_is_refused(text):
    with pytest.raises(CameraError, match="not the settings of a camera process"):
        CameraSettings.from_json(text)
