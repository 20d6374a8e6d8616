"""The tags of sensors that nobody reads, and frames that do not look along z."""

import pytest

from arm_description.urdf.parser import parse_urdf
from arm_gazebo.build_report import Finding
from arm_gazebo.sensors.camera_reader import parse_cameras
from arm_gazebo.sensors.reader import parse_link_sensors

ROBOT = """<robot name="r"><link name="base"/><link name="l"><collision><geometry>
<sphere radius="1"/></geometry></collision></link><link name="o"/>
<joint name="j" type="fixed"><parent link="l"/><child link="o"/>
<origin rpy="-1.5707963 0 -1.5707963"/></joint>
<joint name="b" type="fixed"><parent link="base"/><child link="l"/></joint>
<gazebo reference="{reference}"><sensor name="s" type="{type}">
{inside}
</sensor></gazebo></robot>"""


def findings(type_name: str, inside: str, reference: str = "l") -> list[str]:
    found: list[Finding] = []
    urdf = ROBOT.format(type=type_name, inside=inside, reference=reference)
    parse_cameras(urdf, found.append)
    parse_link_sensors(urdf, parse_urdf(urdf), found.append)
    return [str(finding) for finding in found]


NOT_USED = ": the simulation does not use it"


@pytest.mark.parametrize(
    ("type_name", "inside", "unread"),
    [
        (
            "camera",
            "<camera>\n<image><anti_aliasing>4</anti_aliasing></image>\n<lens><type>stereographic"
            "</type>\n<intrinsics><fx>277</fx><fy>277</fy><cx>160</cx><cy>120</cy></intrinsics>"
            "\n<projection><tx>1</tx></projection></lens></camera>",
            [("image/anti_aliasing", 8), ("lens/type", 9), ("lens/projection", 11)],
        ),
        (
            "rgbd_camera",
            "<camera><depth_camera><clip><near>1</near></clip></depth_camera>\n"
            "<noise><type>gaussian</type><stddev>0</stddev><bias_mean>1</bias_mean></noise>"
            "</camera><plugin name='p'/>",
            [("depth_camera", 7), ("noise/bias_mean", 8), ("plugin", 8)],
        ),
        (
            "imu",
            "<imu><orientation_reference_frame><localization>NED</localization>"
            "</orientation_reference_frame>\n<angular_velocity><x><noise type='gaussian'>"
            "<stddev>1</stddev><dynamic_bias_stddev>1</dynamic_bias_stddev></noise></x>"
            "</angular_velocity></imu>",
            [
                ("orientation_reference_frame", 7),
                ("angular_velocity/x/noise/dynamic_bias_stddev", 8),
            ],
        ),
        (
            "contact",
            "<contact><topic>t</topic><threshold>3</threshold></contact>",
            [("threshold", 7)],
        ),
        ("force_torque", "<force_torque>\n<unit>lbf</unit></force_torque>", [("unit", 8)]),
    ],
)
def test_each_tag_that_nobody_reads_is_listed_with_its_line(type_name, inside, unread):
    reference = "j" if type_name == "force_torque" else "l"
    assert findings(type_name, inside, reference) == [
        f"<{tag}> of {type_name} 's' (line {line}){NOT_USED}" for tag, line in unread
    ]


@pytest.mark.parametrize(
    ("type_name", "inside"),
    [
        ("camera", "<always_on>1</always_on><visualize>0</visualize><pose>1 0 0 0 0 0</pose>"),
        ("camera", "<camera name='x'><noise><type>none</type><mean>0</mean></noise></camera>"),
        ("depth_camera", "<topic>a</topic><camera><clip><far>9</far></clip></camera>"),
        ("rgbd_camera", "<gz_frame_id>o</gz_frame_id><points_topic>p</points_topic>"),
        ("imu", "<imu><enable_orientation>0</enable_orientation></imu>"),
        ("contact", "<contact><collision>l_collision</collision></contact>"),
    ],
)
def test_tags_that_are_read_or_change_nothing_are_not_listed(type_name, inside):
    assert findings(type_name, inside) == []


def test_attributes_that_nobody_reads_are_listed():
    pose = "<pose relative_to='base' degrees='true' rotation_format='euler_rpy'>0 0 0 0 0 0</pose>"
    said = "<pose> of imu 's' (line 7): the simulation does not use {}"
    assert findings("imu", pose) == [
        said.format("relative_to='base'"),
        said.format("degrees='true'"),
    ]
    assert findings("imu", "<pose relative_to='' degrees='false'>0 0 0 0 0 0</pose>") == []


def test_one_of_several_shapes_of_a_contact_sensor_is_listed():
    inside = "<contact><collision>l_collision</collision></contact>"
    second = '<collision><geometry><sphere radius="1"/></geometry></collision></link>'
    urdf = ROBOT.format(type="contact", inside=inside, reference="l")
    urdf = urdf.replace("</collision></link>", f"</collision>{second}", 1)
    found: list[Finding] = []
    parse_link_sensors(urdf, parse_urdf(urdf), found.append)
    assert [str(finding) for finding in found] == [f"<collision> of contact 's' (line 7){NOT_USED}"]


def test_a_second_tag_where_one_counts_is_listed():
    inside = (
        "<camera><horizontal_fov>1</horizontal_fov>\n<horizontal_fov>2</horizontal_fov></camera>"
    )
    assert findings("camera", inside) == [
        "<horizontal_fov> of camera 's' (line 8): there is another one, and only one counts"
    ]
    topics = "<topic>a</topic><topic>b</topic>"
    assert findings("camera", topics) == []


@pytest.mark.parametrize(
    ("reference", "inside", "frame"),
    [
        ("o", "", "o"),
        ("l", "<gz_frame_id>l</gz_frame_id>", "l"),
        ("l", "<gz_frame_id>elsewhere</gz_frame_id>", ""),
        ("l", "<pose>0 0 0 0 0.5 0</pose>", "o"),
        ("l", "", ""),
    ],
)
def test_a_frame_that_does_not_look_where_the_camera_looks_is_doubtful(reference, inside, frame):
    said = findings("camera", inside, reference)
    if not frame:
        assert said == []
        return
    assert said == [
        f"camera 's' (line 6): its images and camera_info have the frame '{frame}', whose z axis "
        f"does not look where the camera looks (REP 103); give '{reference}' a child link by a "
        "fixed joint with the rpy -1.5708 0 -1.5708"
    ]
