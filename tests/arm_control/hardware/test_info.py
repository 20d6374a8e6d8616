"""<ros2_control> blocks, right and wrong."""

import pytest

from arm_control.errors import HardwareInfoError
from arm_control.hardware.info import HardwareInfo, parse_hardware_info
from arm_description.urdf.robot import Mimic


def robot(*blocks: str) -> str:
    return f"<robot name='r'>{''.join(blocks)}</robot>"


def block(inner: str = "", name: str = "H", type_: str = "system", plugin: str = "p/P") -> str:
    return (
        f"<ros2_control name='{name}' type='{type_}'>"
        f"<hardware><plugin>{plugin}</plugin><param name='port'>/dev/x</param></hardware>"
        f"{inner}</ros2_control>"
    )


def parse_one(inner: str) -> HardwareInfo:
    (info,) = parse_hardware_info(robot(block(inner)))
    return info


JOINT = """
<joint name="j0">
  <command_interface name="position">
    <param name="min">-1.5</param><param name="max">2</param>
  </command_interface>
  <state_interface name="position"><param name="initial_value">0.25</param></state_interface>
  <state_interface name="velocity"/>
  <param name="gear">3</param>
</joint>
"""


def test_a_robot_in_a_namespace_has_its_hardware():
    text = robot(block(JOINT)).replace("<robot", "<robot xmlns='http://www.ros.org'")
    (info,) = parse_hardware_info(text)
    assert [joint.name for joint in info.joints] == ["j0"]


def test_a_description_without_a_block_has_no_hardware():
    assert parse_hardware_info(robot()) == ()


def test_the_components_own_data():
    info = parse_one("")
    assert (info.name, info.type, info.plugin) == ("H", "system", "p/P")
    assert info.parameters == {"port": "/dev/x"}
    assert info.line == 1


def test_a_joint_with_its_interfaces():
    (joint,) = parse_one(JOINT).joints
    (command,) = joint.command_interfaces
    position, velocity = joint.state_interfaces
    assert (command.name, command.minimum, command.maximum) == ("position", -1.5, 2.0)
    assert (position.initial_value, velocity.initial_value) == (0.25, None)
    assert joint.parameters == {"gear": "3"}
    assert command.parameters == {"min": "-1.5", "max": "2"}


def test_an_interface_is_a_double_by_default():
    info = parse_one(
        JOINT + "<gpio name='io'><command_interface name='on' data_type='bool'/>"
        "<state_interface name='on' data_type='bool'/></gpio>"
    )
    assert info.data_types["io/on"] == "bool"
    assert info.data_types["j0/velocity"] == "double"


def test_full_names_come_in_document_order_joints_first():
    info = parse_one(
        "<gpio name='io'><command_interface name='out'/><state_interface name='in'/></gpio>"
        "<sensor name='imu'><state_interface name='gyro.x'/></sensor>" + JOINT
    )
    assert info.state_interface_names == ("j0/position", "j0/velocity", "imu/gyro.x", "io/in")
    assert info.command_interface_names == ("j0/position", "io/out")


def test_several_components():
    infos = parse_hardware_info(robot(block(name="A"), block(name="B", type_="sensor")))
    assert [info.name for info in infos] == ["A", "B"]


@pytest.mark.parametrize(
    ("blocks", "says"),
    [
        ("<ros2_control type='system'/>", "line 1: <ros2_control> has no name"),
        (block(type_="thing"), "has type 'thing'; it must be one of system, actuator, sensor"),
        (block(plugin=""), "has no <hardware><plugin>"),
        ("<ros2_control name='H' type='system'/>", "has no <hardware><plugin>"),
        (block() + block(), "a second <ros2_control> component is named 'H'"),
        (block("<joint/>"), "<joint> of <ros2_control name='H'> has no name"),
        (block("<joint name='a'/><joint name='a'/>"), "has a second <joint> named 'a'"),
        (
            block("<joint name='a'><state_interface/></joint>"),
            "<state_interface> of <joint name='a'> of <ros2_control name='H'> has no name",
        ),
        (
            block("<joint name='a'>" + 2 * "<command_interface name='position'/>" + "</joint>"),
            "has a second <command_interface> named 'position'",
        ),
        (
            block(
                "<joint name='100%d'><state_interface name='position'>"
                "<param name='initial_value'>inf</param></state_interface></joint>"
            ),
            "line 1: 'initial_value' of .* of <joint name='100%d'> of .* is 'inf'; it must be",
        ),
    ],
)
def test_what_is_wrong_is_named_with_its_line(blocks, says):
    with pytest.raises(HardwareInfoError, match=says):
        parse_hardware_info(robot(blocks))


@pytest.mark.parametrize(
    ("data_type", "text", "value"),
    [
        ("bool", "true", 1.0),
        ("bool", "False", 0.0),
        ("bool", "1", 1.0),
        ("double", "nan", None),
        ("double", "NaN", None),
        ("int8", "-3", -3.0),
    ],
)
def test_an_initial_value_is_of_its_interfaces_type(data_type, text, value):
    info = parse_one(
        f"<gpio name='io'><state_interface name='on' data_type='{data_type}'>"
        f"<param name='initial_value'>{text}</param></state_interface></gpio>"
    )
    assert info.gpios[0].state_interfaces[0].initial_value == value


def test_only_a_bool_is_true():
    with pytest.raises(HardwareInfoError, match=r"'initial_value' of .* is 'true'; it must be"):
        parse_one(
            "<gpio name='io'><state_interface name='on'>"
            "<param name='initial_value'>true</param></state_interface></gpio>"
        )


def test_a_limit_that_is_not_a_number_is_ignored():
    limits = "<param name='min'>{-2*pi}</param><param name='max'>3.5</param>"
    text = (
        f"<joint name='a'><command_interface name='position'>{limits}</command_interface></joint>"
    )
    (component,) = parse_hardware_info(robot(block(text)))
    (interface,) = component.joints[0].command_interfaces
    assert (interface.minimum, interface.maximum) == (None, 3.5)
    assert interface.unread_limits == ("min",)


def test_the_line_is_that_of_the_element():
    text = robot("\n\n", block("\n<joint name='a'/>\n<joint name='a'/>"))
    with pytest.raises(HardwareInfoError, match=r"^line 5:"):
        parse_hardware_info(text)


def test_the_group_of_a_component():
    (info,) = parse_hardware_info(
        "<robot><ros2_control name='H' type='system'><hardware><plugin>p/P</plugin>"
        "<group> arms </group></hardware></ros2_control></robot>"
    )
    assert info.group == "arms"
    assert parse_one("").group == ""


# xacro writes a boolean as Python does.
@pytest.mark.parametrize("false", ["false", "False", " false "])
def test_what_a_joint_mimics_comes_from_the_urdf(false):
    joints = f"<joint name='a'/><joint name='b' mimic='True'/><joint name='c' mimic='{false}'/>"
    (info,) = parse_hardware_info(
        "<robot><joint name='b'><mimic joint='a' multiplier='0' offset='0.5'/></joint>"
        f"<joint name='c'><mimic joint='a'/></joint>{block(joints)}</robot>"
    )
    assert [joint.mimic for joint in info.joints] == [None, Mimic("a", 0.0, 0.5), None]


def test_a_mimic_that_is_not_a_number_is_named_with_its_line():
    with pytest.raises(
        HardwareInfoError, match="line 2: 'multiplier' of <mimic> in <joint name='b%d'> is 'x'; it"
    ):
        parse_hardware_info(
            "<robot>\n<joint name='b%d'><mimic joint='a' multiplier='x'/></joint></robot>"
        )


def with_attributes(attributes: str) -> HardwareInfo:
    text = block().replace("type='system'", f"type='system' {attributes}")
    (info,) = parse_hardware_info(robot(text))
    return info


@pytest.mark.parametrize(
    ("attributes", "rate_hz", "is_async"),
    [
        ("", 0, False),
        ("rw_rate='50' is_async='true'", 50, True),
        ("rw_rate='0' is_async='False'", 0, False),
    ],
)
def test_a_component_may_ask_for_a_rate_and_a_thread(attributes, rate_hz, is_async):
    info = with_attributes(attributes)
    assert (info.read_write_rate_hz, info.is_async) == (rate_hz, is_async)


@pytest.mark.parametrize("text", ["-1", "2.5", "fast", ""])
def test_a_rate_is_a_whole_number(text):
    with pytest.raises(HardwareInfoError, match=rf"rw_rate of .*'H'> is '{text}'; it must be a wh"):
        with_attributes(f"rw_rate='{text}'")
