"""What `arm check` finds in descriptions, and how often it parses them."""

import re
from pathlib import Path

import lxml.etree as etree
import pytest
import trimesh

from arm_description import ResourceFinder
from arm_description.urdf import xml_document
from arm_gazebo.build_report import BuildOutcome
from arm_gazebo.check.description import check_description
from arm_gazebo.robot.part import BuildOptions

FOLDER = Path(__file__).with_name("urdfs")
FILES = sorted(FOLDER.glob("*.urdf"))
EXPECTED = re.compile(r"\A<!--\n(.*?)\n-->\n", re.DOTALL)


def outcome(text: str, name: str) -> list[str]:
    check = check_description(text, name)
    found = [f"{finding.outcome.value:<8}  {finding}" for finding in check.findings]
    return ["usable" if check.is_usable else "not usable", *found]


def test_the_folder_of_urdfs_exists():
    assert len(FILES) > 40


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_the_findings_of_a_file_match_its_comment(file):
    text = file.read_text()
    written = EXPECTED.match(text)
    assert written is not None
    expected, found = written.group(1).splitlines(), outcome(text, file.name)
    assert len(found) == len(expected), found
    for line, beginning in zip(found, expected, strict=True):
        assert line.startswith(beginning)


ROBOT = """\
<robot name="r">
  <link name="base"/>
  <link name="arm">
    <inertial><mass value="1"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/>
    </inertial>
  </link>
  <joint name="j" type="revolute">
    <parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" velocity="2" effort="3"/>
  </joint>
  <ros2_control name="sim" type="system">
    <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
    <joint name="j"><command_interface name="position"/></joint>
  </ros2_control>
  <gazebo reference="arm"><sensor name="imu" type="imu"/><mu1>0.5</mu1></gazebo>
</robot>
"""


def test_a_check_parses_a_complete_description_once(monkeypatch):
    parsed = []

    def fromstring(data, parser):
        parsed.append(data)
        return etree.XML(data, parser)

    monkeypatch.setattr(xml_document.etree, "fromstring", fromstring)
    assert check_description(ROBOT, "r.urdf").is_usable
    assert len([data for data in parsed if b"<robot" in data]) == 1


INERTIAL = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'


@pytest.fixture
def doubts(tmp_path):
    """Return what is doubted of an arm of two links, 0.3 m apart, that draw a mesh."""

    def check(size_m, scale, joint_m=0.3):
        trimesh.creation.box([size_m, size_m / 2, size_m / 4]).export(tmp_path / "part.stl")
        visual = (
            f'<visual><geometry><mesh filename="part.stl" scale="{scale}"/></geometry></visual>'
        )
        urdf = (
            f'<robot name="r"><link name="base">{INERTIAL}</link>'
            f'<link name="arm">{INERTIAL}{visual}</link>'
            f'<joint name="j" type="fixed"><origin xyz="0 0 {joint_m}"/><parent link="base"/>'
            '<child link="arm"/></joint></robot>'
        )
        options = BuildOptions(resources=ResourceFinder(tmp_path / "arm.urdf"))
        findings = check_description(urdf, "arm.urdf", options).findings
        return [str(found) for found in findings if found.outcome is BuildOutcome.DOUBTFUL]

    return check


@pytest.mark.parametrize(
    ("size_m", "scale", "said"),
    [
        (0.05, "0.001 0.001 0.001", "is only 0.05 mm large, too small to see, but the next"),
        (0.25, "0.001 0.001 0.001", "is only 0.25 mm large, too small to see, but the next"),
        (0.05, "0.001 0.001 0.001", "is its scale, 0.001 0.001 0.001, right?"),
        (80.0, "1 1 1", "is 80 m large, but the next joint is 0.3 m away; is its scale, 1 1 1"),
    ],
)
def test_a_mesh_in_other_units_is_doubted(doubts, size_m, scale, said):
    [doubt] = doubts(size_m, scale)
    assert doubt.startswith("link 'arm' (line 1): its mesh part.stl ")
    assert said in doubt


@pytest.mark.parametrize("size_m", [0.002, 0.05, 0.3, 15.0])
def test_plausible_sizes_cause_no_warning(doubts, size_m):
    assert doubts(size_m, "1 1 1") == []


def test_without_any_distance_only_the_invisible_is_doubted(doubts):
    assert doubts(80.0, "1 1 1", joint_m=0.0) == []
    [doubt] = doubts(5e-5, "1 1 1", joint_m=0.0)
    assert "too small to see; is its scale" in doubt
