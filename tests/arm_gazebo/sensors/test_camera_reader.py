"""Cameras as a URDF describes them."""

import logging

import numpy as np
import pytest

from arm_gazebo.errors import SensorError
from arm_gazebo.sensors.camera import CameraSensor
from arm_gazebo.sensors.camera_reader import parse_cameras

LINKS = '<link name="base_link"/><link name="camera_link"/><link name="eye"/>'
OPTICAL_JOINT = (
    '<joint name="optical" type="fixed"><parent link="camera_link"/><child link="eye"/>'
    '<origin xyz="0 0 0" rpy="-1.5708 0 -1.5708"/></joint>'
)


def robot(*sensors: str, extra: str = "", link: str = "camera_link") -> str:
    gazebo = "".join(f'<gazebo reference="{link}">{sensor}</gazebo>' for sensor in sensors)
    return f'<?xml version="1.0"?>\n<robot name="r">{LINKS}{extra}{gazebo}</robot>'


def sensor(inside: str = "", name: str = "camera") -> str:
    return f'<sensor name="{name}" type="camera">{inside}</sensor>'


def camera(inside: str = "", extra: str = "") -> CameraSensor:
    (found,) = parse_cameras(robot(sensor(inside), extra=extra))
    return found


def test_a_robot_without_sensors_has_no_cameras():
    assert parse_cameras(robot()) == ()


def test_every_tag_is_read():
    found = camera(
        "<always_on>1</always_on><update_rate>15</update_rate><topic>/videocamera</topic>"
        "<optical_frame_id>camera_optical_frame</optical_frame_id>"
        "<camera><horizontal_fov>1.396</horizontal_fov>"
        "<image><width>800</width><height>600</height><format>R8G8B8</format></image>"
        "<clip><near>0.02</near><far>300</far></clip>"
        "<noise><type>gaussian</type><mean>0.01</mean><stddev>0.007</stddev></noise></camera>"
        "<pose>0.1 0.2 0.3 0 0.5 0</pose>"
    )
    assert found == CameraSensor(
        name="camera",
        link="camera_link",
        optical_frame="camera_optical_frame",
        width=800,
        height=600,
        hfov=1.396,
        near=0.02,
        far=300.0,
        rate_hz=15.0,
        noise_mean=0.01,
        noise_stddev=0.007,
        image_topics=("/videocamera",),
        info_topics=("/videocamera/camera_info", "/camera_info"),
        xyz=(0.1, 0.2, 0.3),
        rpy=(0.0, 0.5, 0.0),
    )


def test_what_is_left_out_has_gazebos_defaults():
    assert camera() == CameraSensor(
        name="camera",
        link="camera_link",
        optical_frame="camera_link",
        width=320,
        height=240,
        hfov=1.047,
        near=0.1,
        far=100.0,
        rate_hz=30.0,
        image_topics=("camera",),
        info_topics=("camera/camera_info", "camera_info"),
    )


def test_rate_zero_is_the_default_rate():
    assert camera("<update_rate>0</update_rate>").rate_hz == 30.0


def test_several_topics_and_named_info_topics():
    found = camera(
        "<topic>/camera/image_raw</topic><topic>/videocamera</topic>"
        "<camera_info_topic>/a/info</camera_info_topic><camera_info_topic>b</camera_info_topic>"
    )
    assert found.image_topics == ("/camera/image_raw", "/videocamera")
    assert found.info_topics == ("/a/info", "b")


@pytest.mark.parametrize("tag", ["optical_frame_id", "gz_frame_id", "ignition_frame_id"])
def test_the_optical_frame_has_several_names(tag):
    assert camera(f"<camera><{tag}>eye</{tag}></camera>").optical_frame == "eye"


def test_the_optical_frame_is_found_by_its_orientation():
    assert camera(extra=OPTICAL_JOINT).optical_frame == "eye"


def test_the_optical_frame_may_be_a_link_further():
    between = (
        '<joint name="a" type="fixed"><parent link="camera_link"/><child link="base_link"/></joint>'
    )
    further = OPTICAL_JOINT.replace('parent link="camera_link"', 'parent link="base_link"')
    assert camera(extra=between + further).optical_frame == "eye"


RGBD = '<sensor name="camera" type="rgbd_camera">{}<pose>1 2 3 0 0 0</pose></sensor>'


@pytest.mark.parametrize(
    ("frame", "axes", "origin"),
    [
        # The camera looks along x of its link, and along z of its optical frame.
        ("camera_link", [[0, 0, 1], [-1, 0, 0], [0, -1, 0]], [1, 2, 3]),
        ("eye", [[1, 0, 0], [0, 1, 0], [0, 0, 1]], [-2, -3, 1]),
        ("elsewhere", [[1, 0, 0], [0, 1, 0], [0, 0, 1]], [0, 0, 0]),
    ],
)
def test_points_know_how_their_frame_looks(frame, axes, origin):
    urdf = robot(RGBD.format(f"<gz_frame_id>{frame}</gz_frame_id>"), extra=OPTICAL_JOINT)
    (found,) = parse_cameras(urdf)
    optics = np.reshape(found.optics_in_frame, (3, 4))
    np.testing.assert_allclose(optics[:, :3], axes, atol=1e-5)
    np.testing.assert_allclose(optics[:, 3], origin, atol=1e-4)


def test_noise_of_type_none_is_zero():
    found = camera("<camera><noise><type>none</type><stddev>0.1</stddev></noise></camera>")
    assert found.noise_stddev == 0.0


def test_a_name_that_is_not_a_valid_topic_is_converted():
    (found,) = parse_cameras(robot(sensor(name="front-camera 1")))
    assert found.image_topics == ("front_camera_1",)


def test_a_second_camera_leaves_the_shared_info_topic_to_the_first():
    first, second = parse_cameras(robot(sensor(name="a"), sensor(name="b")))
    assert first.info_topics == ("a/camera_info", "camera_info")
    assert second.info_topics == ("b/camera_info",)


def test_other_sensors_are_named_and_left_out(caplog):
    lidar = '<sensor name="laser" type="gpu_lidar"/>'
    with caplog.at_level(logging.WARNING):
        assert parse_cameras(robot(lidar)) == ()
    assert "'laser'" in caplog.text
    assert "'gpu_lidar'" in caplog.text


def test_a_depth_camera_has_gazebos_topics_and_no_picture():
    depth = sensor("<topic>/head/depth</topic>").replace('"camera">', '"depth_camera">')
    (found,) = parse_cameras(robot(depth))
    assert found.depth_topics == ("/head/depth",)
    assert found.points_topics == ("/head/depth/points",)
    assert found.info_topics == ("/head/depth/camera_info", "/head/camera_info")
    assert found.image_topics == ()
    assert found.measures_depth


def test_an_rgbd_camera_has_gazebos_topics_below_its_own():
    rgbd = sensor("<topic>camera_head</topic>").replace('"camera">', '"rgbd_camera">')
    (found,) = parse_cameras(robot(rgbd))
    assert found.topics == (
        "camera_head/image",
        "camera_head/depth_image",
        "camera_head/points",
        "camera_head/camera_info",
    )


def test_each_topic_of_an_rgbd_camera_may_have_its_own_name():
    names = ("image_topic", "depth_image_topic", "points_topic", "camera_info_topic")
    tags = "".join(f"<{name}>/d435/{name}</{name}>" for name in names)
    (found,) = parse_cameras(robot(sensor(tags).replace('"camera">', '"rgbd_camera">')))
    assert found.topics == tuple(f"/d435/{name}" for name in names)


def test_noise_type_may_be_an_attribute():
    noise = '<camera><noise type="gaussian"><stddev>0.1</stddev></noise></camera>'
    assert camera(noise).noise_stddev == 0.1
    with pytest.raises(SensorError, match="type 'salt' is not one of none, gaussian"):
        camera(noise.replace("gaussian", "salt"))


def test_cameras_have_rates_sizes_and_noise_of_their_own():
    wide = "<camera><image><width>640</width></image></camera><update_rate>5</update_rate>"
    noise = "<camera><noise><type>gaussian</type><stddev>0.02</stddev></noise></camera>"
    first, second = parse_cameras(robot(sensor(wide, "a"), sensor(noise, "b")))
    assert (first.width, first.rate_hz, first.noise_stddev) == (640, 5.0, 0.0)
    assert (second.width, second.rate_hz, second.noise_stddev) == (320, 30.0, 0.02)


def test_a_field_of_view_is_square_pixels_and_a_centred_axis():
    lens = CameraSensor("c", "l", "f", width=320, height=240, hfov=1.047).lens
    assert lens.fx == lens.fy == pytest.approx(277.19, abs=0.01)
    assert (lens.cx, lens.cy, lens.skew, lens.is_pinhole) == (160, 120, 0, True)


@pytest.mark.parametrize(
    ("inside", "tag", "said"),
    [
        ("<camera><image><width>0</width></image></camera>", "image/width", "'0'"),
        ("<camera><image><height>2.5</height></image></camera>", "image/height", "whole number"),
        ("<camera><image><width>99999</width></image></camera>", "image/width", "8192"),
        ("<camera><image><format>P6</format></image></camera>", "image/format", "R8G8B8"),
        ("<camera><horizontal_fov>3.2</horizontal_fov></camera>", "horizontal_fov", "(0, pi)"),
        ("<camera><horizontal_fov>nan</horizontal_fov></camera>", "horizontal_fov", "'nan'"),
        ("<camera><clip><near>0</near></clip></camera>", "clip/near", "above 0"),
        ("<camera><clip><near>2</near><far>1</far></clip></camera>", "clip/far", "above near, 2"),
        ("<update_rate>-5</update_rate>", "update_rate", "at least 0, not '-5'"),
        ("<update_rate>fast</update_rate>", "update_rate", "'fast'"),
        ("<update_rate>inf</update_rate>", "update_rate", "'inf'"),
        ("<topic>/bad topic</topic>", "topic", "'/bad topic' is not a valid ROS topic"),
        ("<topic>t</topic><camera_info_topic>t</camera_info_topic>", "topic", "taken"),
        ("<camera><noise><type>salt</type></noise></camera>", "noise/type", "gaussian"),
        (
            "<camera><noise><type>gaussian</type><stddev>-1</stddev></noise></camera>",
            "noise/stddev",
            "from 0 to 1",
        ),
        ("<pose>1 2 3</pose>", "pose", "six numbers"),
        ("<pose>1 2 3 4 5 x</pose>", "pose", "six numbers"),
    ],
)
def test_nonsense_names_sensor_tag_and_line(inside, tag, said):
    with pytest.raises(SensorError) as caught:
        camera(inside)
    message = str(caught.value)
    assert message.startswith(f"camera sensor 'camera', <{tag}> (line 2): ")
    assert said in message


def test_a_camera_on_a_link_that_is_not_there_is_left_out():
    assert parse_cameras(robot(sensor(), link="head")) == ()


def test_two_cameras_of_one_name_on_a_link_are_refused():
    with pytest.raises(SensorError, match="second camera of this name on link 'camera_link'"):
        parse_cameras(robot(sensor("<topic>a</topic>"), sensor("<topic>b</topic>")))


def on_two_links(left: str = "", right: str = "") -> str:
    """Return a robot with a camera of the same name on each of two links, and one more."""
    return robot(
        sensor(name="other"),
        extra=f'<gazebo reference="base_link">{sensor(left)}</gazebo>'
        f'<gazebo reference="eye">{sensor(right)}</gazebo>',
    )


def test_cameras_of_one_name_on_several_links_get_their_links_as_prefix():
    cameras = parse_cameras(on_two_links("<topic>left/image</topic>", "<topic>right/image</topic>"))
    assert [(c.name, c.link) for c in cameras] == [
        ("base_link/camera", "base_link"),
        ("eye/camera", "eye"),
        ("other", "camera_link"),
    ]
    assert [c.image_topics for c in cameras[:2]] == [("left/image",), ("right/image",)]


def test_cameras_of_one_name_on_several_links_need_topics_of_their_own():
    with pytest.raises(SensorError, match="'camera' is taken by camera 'camera' of link 'base_l"):
        parse_cameras(on_two_links())


def test_two_cameras_on_one_topic_are_refused():
    cameras = (sensor("<topic>/t</topic>", name=name) for name in ("a", "b"))
    with pytest.raises(SensorError, match=r"'b'.*'/t' is taken by camera 'a'"):
        parse_cameras(robot(*cameras))


def test_a_sensor_without_a_name_is_refused():
    with pytest.raises(SensorError, match="needs a name"):
        parse_cameras(robot(sensor(name="")))
