"""IMUs, force-torque and contact sensors as a URDF describes them."""

from collections.abc import Sequence

import pytest

from arm_description.urdf.parser import parse_urdf
from arm_gazebo.errors import SensorError
from arm_gazebo.sensors.contact import ContactSensor
from arm_gazebo.sensors.force_torque import ForceTorqueSensor
from arm_gazebo.sensors.imu import ImuSensor
from arm_gazebo.sensors.link_sensor import LinkSensor
from arm_gazebo.sensors.noise import NoiseModel
from arm_gazebo.sensors.reader import parse_link_sensors


def sensors(*tags: tuple[str, str, str], names: Sequence[str] = "abc") -> tuple[LinkSensor, ...]:
    """Read sensors of a reference, a type and what stands inside, with names of their own."""
    gazebo = "".join(
        f'<gazebo reference="{reference}">'
        f'<sensor name="{name}" type="{kind}">{inside}</sensor></gazebo>'
        for name, (reference, kind, inside) in zip(names, tags, strict=False)
    )
    urdf = (
        '<robot name="r"><link name="base"/><link name="hand"/><joint name="wrist" type="fixed">'
        f'<parent link="base"/><child link="hand"/></joint>{gazebo}</robot>'
    )
    return parse_link_sensors(urdf, parse_urdf(urdf))


def test_a_sensor_of_a_link_that_is_not_there_is_left_out():
    (imu,) = sensors(("nose", "imu", "<update_rate>-1</update_rate>"), ("hand", "imu", ""))
    assert imu.name == "b"


def test_what_is_left_out_has_defaults():
    assert sensors(("hand", "imu", ""), ("wrist", "force_torque", ""), ("hand", "contact", "")) == (
        ImuSensor("a", "hand", "hand", "a"),
        ForceTorqueSensor("b", "hand", "hand", "b", parent="base"),
        ContactSensor("c", "hand", "hand", "c"),
    )


@pytest.mark.parametrize(
    ("name", "topic"),
    [
        ("front imu", "front_imu"),
        ("9dof_imu", "_9dof_imu"),
        ("hand/9dof", "hand/_9dof"),
        ("/hand//imu/", "/hand/imu"),
        ("/", "sensor"),
        ("\u0661", "_"),
    ],
)
def test_any_name_makes_a_topic(name, topic):
    (imu,) = sensors(("hand", "imu", ""), names=(name,))
    assert (imu.name, imu.topic) == (name, topic)


def test_every_tag_of_an_imu_is_read():
    (imu,) = sensors(
        (
            "hand",
            "imu",
            "<always_on>true</always_on><update_rate>50</update_rate><topic>/imu/data</topic>"
            "<gz_frame_id>imu_link</gz_frame_id><pose>1 2 3 0 0.5 0</pose>"
            "<enable_orientation>false</enable_orientation><imu>"
            '<angular_velocity><z><noise type="gaussian"><mean>0.1</mean><stddev>0.2</stddev>'
            "<bias_mean>0.3</bias_mean><bias_stddev>0.4</bias_stddev></noise></z>"
            "</angular_velocity><linear_acceleration><x><noise><type>gaussian</type>"
            "<stddev>0.5</stddev></noise></x></linear_acceleration></imu>",
        )
    )
    silent = NoiseModel()
    assert imu == ImuSensor(
        *("a", "hand", "imu_link", "/imu/data", 50.0, (1.0, 2.0, 3.0), (0.0, 0.5, 0.0)),
        angular_velocity_noise=(silent, silent, NoiseModel(0.1, 0.2, 0.3, 0.4)),
        linear_acceleration_noise=(NoiseModel(stddev=0.5), silent, silent),
        has_orientation=False,
    )


def test_every_tag_of_a_force_torque_sensor_is_read():
    (wrist,) = sensors(
        (
            "wrist",
            "force_torque",
            "<update_rate>200</update_rate><topic>wrench</topic><force_torque><frame>parent</frame>"
            "<measure_direction>parent_to_child</measure_direction>"
            '<torque><y><noise type="gaussian"><stddev>0.1</stddev></noise></y></torque>'
            "</force_torque>",
        )
    )
    assert isinstance(wrist, ForceTorqueSensor)
    assert (wrist.frame, wrist.frame_id, wrist.parent) == ("parent", "base", "base")
    assert (wrist.direction, wrist.rate_hz, wrist.topic) == ("parent_to_child", 200.0, "wrench")
    assert [model.stddev for model in wrist.noise] == [0, 0, 0, 0, 0.1, 0]


@pytest.mark.parametrize(
    ("reference", "kind", "inside", "said"),
    [
        ("wrist", "imu", "", "imu sensor 'a', <gazebo> (line 1): no link 'wrist'; the robot has"),
        ("hand", "force_torque", "", "no joint 'hand'; the robot has wrist"),
        ("hand", "imu", "<update_rate>-1</update_rate>", "at least 0, not '-1'"),
        ("hand", "imu", "<topic>a b</topic>", "'a b' is not a valid ROS topic name"),
        (
            "hand",
            "imu",
            "<imu><linear_acceleration><x><noise type='pink'/></x></linear_acceleration></imu>",
            "type 'pink' is not one of none, gaussian, gaussian_quantized",
        ),
        (
            "wrist",
            "force_torque",
            "<force_torque><frame>world</frame></force_torque>",
            "'world' is not one of child, parent, sensor",
        ),
        (
            "wrist",
            "force_torque",
            "<force_torque><measure_direction>up</measure_direction></force_torque>",
            "'up' is not one of child_to_parent, parent_to_child",
        ),
    ],
)
def test_nonsense_is_refused_with_a_sentence(reference, kind, inside, said):
    with pytest.raises(SensorError) as caught:
        sensors((reference, kind, inside))
    assert said in str(caught.value)


def test_two_sensors_on_one_topic_are_refused():
    topic = "<topic>t</topic>"
    with pytest.raises(SensorError, match=r"contact sensor 'b'.*'t' is taken by sensor 'a'"):
        sensors(("hand", "imu", topic), ("hand", "contact", topic))


def test_cameras_and_unknown_sensors_are_left_to_others():
    assert sensors(("hand", "camera", ""), ("hand", "sonar", "")) == ()


def test_sensors_of_one_name_on_several_links_get_their_links_as_prefix():
    one, other, third = sensors(
        ("base", "imu", "<topic>b</topic>"),
        ("hand", "imu", "<topic>h</topic>"),
        ("hand", "contact", ""),
        names="aac",
    )
    assert (one.name, one.topic) == ("base/a", "b")
    assert (other.name, other.topic) == ("hand/a", "h")
    assert third.name == "c"


def test_two_sensors_of_one_name_on_a_link_are_refused():
    with pytest.raises(SensorError, match="a second sensor of this name on link 'hand'"):
        sensors(("hand", "imu", ""), ("wrist", "force_torque", "<topic>t</topic>"), names="aa")


def test_sensors_of_one_name_need_topics_of_their_own():
    with pytest.raises(SensorError, match="'a' is taken by sensor 'a' of link 'base'; give one"):
        sensors(("base", "imu", ""), ("hand", "imu", ""), names="aa")
