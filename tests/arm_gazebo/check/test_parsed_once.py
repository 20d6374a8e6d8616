"""How often a check parses a description."""

import lxml.etree as etree

from arm_description.urdf import xml_document
from arm_gazebo.check.description import check_description

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
