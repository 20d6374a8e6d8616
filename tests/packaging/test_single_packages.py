"""`pip install ./PACKAGE`: a folder installs by itself, with what it needs from beside it."""

import json
from pathlib import Path

import pytest

# It builds two packages, on a machine that may be busy with something else.
pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]

LOOK = """\
import json
from pathlib import Path
from ament_index_python import get_package_share_directory
import arm_description, arm_node
from arm_description import expand_xacro, parse_urdf

share = get_package_share_directory("arm_description")
urdf = expand_xacro(Path(share, "urdf/arm.urdf.xacro"), {"camera": "none"})
print(json.dumps({
    "places": [arm_description.__file__, arm_node.__file__, share],
    "joints": [joint.name for joint in parse_urdf(urdf).joints if joint.limit],
}))
"""


def test_a_package_folder_is_installed_by_itself(description_alone, tmp_path):
    seen = json.loads(
        description_alone.run(description_alone.python, "-c", LOOK, folder=tmp_path).stdout
    )
    assert seen["joints"] == ["j0", "j1", "j2", "j3"]
    for path in seen["places"]:
        assert Path(path).is_relative_to(description_alone.modules)
    installed = {path.name for path in description_alone.executable("any").parent.iterdir()}
    assert {"robot_state_publisher", "joint_state_publisher"} <= installed
    assert "arm_gazebo_node" not in installed
