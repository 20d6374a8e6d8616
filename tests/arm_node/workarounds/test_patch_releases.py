import mujoco
import numpy as np
import pytest

from arm_node.workarounds import patch_releases
from arm_node.workarounds.patch_releases import for_version, saved_version, version_text

pytestmark = pytest.mark.workaround("patch_releases")

HERE = mujoco.mj_version()
OTHER = HERE + 1
ARM = "<mujoco><worldbody><body><joint name='j'/><geom size='0.1'/></body></worldbody></mujoco>"


@pytest.fixture
def saved():
    model = mujoco.MjModel.from_xml_string(ARM)
    content = np.empty(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, content)
    return content.tobytes()


def read(content):
    return mujoco.MjModel.from_binary_path("a.mjb", {"a.mjb": content})


def test_a_model_says_which_version_saved_it(saved):
    assert saved_version(saved) == HERE
    assert version_text(HERE) == mujoco.__version__


def test_mujoco_reads_what_another_patch_release_has_saved(saved):
    theirs = for_version(saved, OTHER)
    with pytest.raises(ValueError, match="failed to load"):
        read(theirs)
    assert for_version(theirs, HERE) == saved
    assert read(for_version(theirs, HERE)).joint("j").id == 0


def test_the_model_of_another_release_keeps_its_version(saved):
    theirs = for_version(saved, OTHER)
    assert for_version(theirs, HERE + 1000) == theirs


def test_what_is_too_short_to_be_a_model_is_left_alone():
    assert saved_version(b"short") is None
    assert for_version(b"short", HERE) == b"short"


def test_it_can_be_switched_off(saved, monkeypatch):
    theirs = for_version(saved, OTHER)
    monkeypatch.setattr(patch_releases, "is_on", lambda _: False)
    assert for_version(theirs, HERE) == theirs
