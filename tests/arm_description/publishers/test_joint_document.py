"""The joints that joint_state_publisher reads from URDF, SDF and COLLADA."""

import math

import pytest

from arm_description.errors import UrdfError, XmlError
from arm_description.publishers.joint_document import read_joints
from arm_description.publishers.joint_state_merge import JointStateMerge
from arm_description.publishers.settings import JointPublisherSettings

TWO_ROOTS = """<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
  <joint name="j0" type="continuous"><parent link="a"/><child link="b"/></joint>
  <joint name="j1" type="prismatic"><parent link="c"/><child link="d"/>
    <limit lower="1" upper="2" effort="1" velocity="1"/></joint>
</robot>"""

SDF = """<?xml version="1.0"?>
<sdf version="1.9"><world name="w"><model name="m">
  <link name="a"/><link name="b"/>
  <joint name="turn" type="revolute"><parent>a</parent><child>b</child>
    <axis><xyz>0 0 1</xyz><limit><lower>-1.5</lower><upper>0.5</upper></limit></axis></joint>
  <joint name="spin" type="continuous"><parent>a</parent><child>b</child></joint>
  <joint name="slide" type="prismatic"><axis><limit><lower>0.1</lower><upper>0.3</upper></limit>
    </axis></joint>
  <joint name="cardan" type="universal"/><joint name="weld" type="fixed"/>
</model><model name="other"><joint name="no" type="continuous"/></model></world></sdf>"""

COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2008/03/COLLADASchema" version="1.5.0">
  <library_kinematics_models><kinematics_model><technique_common>
    <joint name="elbow"><revolute><axis>0 0 1</axis>
      <limits><min>-90</min><max>180</max></limits></revolute></joint>
    <joint name="weld"><revolute><limits><min>0</min><max>0</max></limits></revolute></joint>
    <joint name="slide"><prismatic/></joint>
  </technique_common></kinematics_model></library_kinematics_models>
</COLLADA>"""


def state(text: str, **settings) -> dict[str, float]:
    merged = JointStateMerge(read_joints(text), JointPublisherSettings(**settings)).state()
    return dict(zip(merged.names, merged.positions, strict=True))


def test_a_robot_with_several_roots_has_joints():
    assert state(TWO_ROOTS) == {"j0": 0.0, "j1": 1.5}
    assert state(f"<urdf>{TWO_ROOTS}</urdf>") == {"j0": 0.0, "j1": 1.5}


def test_the_joints_of_the_first_model_of_an_sdf_with_one_position():
    assert state(SDF) == {"turn": 0.0, "spin": 0.0, "slide": pytest.approx(0.2)}
    turn, spin, _ = read_joints(SDF)
    assert (turn.limit.lower, turn.limit.upper) == (-1.5, 0.5)
    assert spin.type == "continuous"
    assert state(SDF, zeros={"turn": -1.0})["turn"] == -1.0


def test_the_revolute_joints_of_a_collada_document_in_radians():
    (elbow,) = read_joints(COLLADA)
    assert (elbow.name, elbow.limit.lower, elbow.limit.upper) == (
        "elbow",
        pytest.approx(-math.pi / 2),
        pytest.approx(math.pi),
    )
    assert state(COLLADA) == {"elbow": 0.0}


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("<world/>", 'line 1: URDF must have a "robot" tag'),
        ("<sdf/>", 'line 1: SDF must have a "model" tag'),
        (
            SDF.replace("<limit><lower>0.1</lower><upper>0.3</upper></limit>", ""),
            'line 7: Limits must be specified for joint "slide" of type "prismatic"',
        ),
        (
            SDF.replace("<lower>-1.5</lower>", ""),
            'line 5: "lower" limit must be specified for joint "turn" of type "revolute"',
        ),
        (SDF.replace("-1.5", "nan"), '"lower" limit must be a float for joint "turn" of type'),
        (COLLADA.replace(' version="1.5.0"', ""), "COLLADA must have a version tag"),
        (COLLADA.replace('"1.5.0"', '"1.4.1"'), "COLLADA must be at least version 1.5.0"),
        (COLLADA.replace('"1.5.0"', '"new"'), "COLLADA must be at least version 1.5.0"),
        (COLLADA.replace("kinematics_model>", "k>"), 'must have a "kinematics_model" tag'),
        (COLLADA.replace("technique_common>", "t>"), 'must have a "technique_common" tag'),
        (COLLADA.replace("<max>180</max>", ""), '"max" limit must be specified for joint "elbow"'),
    ],
)
def test_missing_parts_are_reported_in_ros_words_with_the_line(text, sentence):
    with pytest.raises(UrdfError) as caught:
        read_joints(text)
    assert sentence in str(caught.value)
    assert str(caught.value).startswith("robot_description, line ")


def test_text_that_is_not_xml_is_refused():
    with pytest.raises(XmlError):
        read_joints("no robot")
