"""arm.rviz: it shows what the arm publishes."""

import yaml

from arm_description import expand_xacro, parse_urdf, resolve_uri


def visualization() -> dict:
    path = resolve_uri("package://arm_description/config/rviz/arm.rviz")
    return yaml.safe_load(path.read_text(encoding="utf-8"))["Visualization Manager"]


def test_the_fixed_frame_is_the_root_of_the_robot():
    robot = parse_urdf(expand_xacro(resolve_uri("package://arm_description/urdf/arm.urdf.xacro")))

    assert visualization()["Global Options"]["Fixed Frame"] == robot.root


def test_it_shows_the_robot_its_frames_and_the_camera():
    displays = {display["Name"]: display for display in visualization()["Displays"]}

    assert set(displays) == {"Grid", "RobotModel", "TF", "Image"}
    assert displays["RobotModel"]["Description Topic"]["Value"] == "/robot_description"
    assert displays["RobotModel"]["Description Topic"]["Durability Policy"] == "Transient Local"
    assert displays["Image"]["Topic"]["Value"] == "/videocamera"
