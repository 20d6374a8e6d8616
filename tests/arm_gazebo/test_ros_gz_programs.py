"""The options of ros_gz_sim's create and of ros_gz_bridge's programs."""

import pytest

from arm_gazebo.errors import GazeboError
from arm_gazebo.ros_gz_bridge_node import Bridged, parse, read_config
from arm_gazebo.ros_gz_create_node import main, parser


@pytest.mark.parametrize(
    ("word", "bridged"),
    [
        (
            "/camera@sensor_msgs/msg/Image@ignition.msgs.Image",
            Bridged("/camera", "/camera", "sensor_msgs/msg/Image"),
        ),
        (
            "/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock",
            Bridged("/clock", "/clock", "rosgraph_msgs/msg/Clock"),
        ),
        (
            "/cmd@geometry_msgs/msg/Twist]gz.msgs.Twist",
            Bridged("/cmd", "/cmd", "geometry_msgs/msg/Twist", to_gazebo=True),
        ),
        ("/camera/image", Bridged("/camera/image", "/camera/image", "sensor_msgs/msg/Image")),
    ],
)
def test_a_bridge_s_word_is_read(word, bridged):
    assert parse(word) == bridged


def test_a_word_of_another_form_is_refused():
    with pytest.raises(GazeboError, match="'/a@b' is not a bridge; it is /topic@ros_package"):
        parse("/a@b")


def test_a_bridge_s_file_is_read(tmp_path):
    file = tmp_path / "bridge.yaml"
    file.write_text(
        """
        - {ros_topic_name: scan, gz_topic_name: lidar, ros_type_name: sensor_msgs/msg/LaserScan,
           gz_type_name: gz.msgs.LaserScan, direction: GZ_TO_ROS}
        - {topic_name: cmd, ros_type_name: geometry_msgs/msg/Twist, direction: ROS_TO_GZ}
        """
    )
    assert read_config(file) == [
        Bridged("lidar", "scan", "sensor_msgs/msg/LaserScan"),
        Bridged("cmd", "cmd", "geometry_msgs/msg/Twist", to_gazebo=True),
    ]
    file.write_text("- {topic_name: cmd, direction: SIDEWAYS, ros_type_name: a/msg/B}\n")
    with pytest.raises(GazeboError, match="a direction of GZ_TO_ROS, ROS_TO_GZ, BIDIRECTIONAL"):
        read_config(file)
    file.write_text("a: 1\n")
    with pytest.raises(GazeboError, match="is not a list of topics"):
        read_config(file)


def test_create_takes_the_words_of_ros_gz_sim():
    words = ["-topic", "robot_description", "-name", "arm", "-allow_renaming", "-x", "-0.5"]
    options = parser().parse_args([*words, "-Y", "1.57"])
    assert (options.topic, options.name, options.allow_renaming) == (
        "robot_description",
        "arm",
        "true",
    )
    assert (options.x, options.z, options.Y) == (-0.5, 0.0, 1.57)


def test_create_reports_what_is_missing(capsys):
    with pytest.raises(SystemExit):
        main(["create", "-name", "arm"])
    assert "give what to create: -topic TOPIC, -file FILE" in capsys.readouterr().err


def test_create_reads_what_follows_the_ros_arguments(capsys):
    with pytest.raises(SystemExit) as ended:
        main(["create", "-file", "a.urdf", "--ros-args", "-r", "a:=b", "--", "-x", "far"])
    assert ended.value.code == 2
    assert "argument -x/--x: invalid float value: 'far'" in capsys.readouterr().err
