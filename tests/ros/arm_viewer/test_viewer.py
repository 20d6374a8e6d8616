"""What the page's node makes of topics, and what it publishes; without a page."""

import numpy as np
import pytest

pytestmark = pytest.mark.ros

URDF = """<robot name='r'><link name='base'/><link name='arm'/><link name='finger'/>
  <joint name='turn' type='revolute'><parent link='base'/><child link='arm'/>
    <limit lower='-1' upper='1' effort='1' velocity='1'/></joint>
  <joint name='grip' type='revolute'><parent link='arm'/><child link='finger'/>
    <limit lower='-3' upper='3' effort='1' velocity='1'/><mimic joint='turn' multiplier='2'/>
  </joint></robot>"""


def test_robots_are_found_in_every_namespace(client, viewer, latched):
    from std_msgs.msg import String

    for namespace, text in (("left", URDF), ("right", "<robot name='r'/>")):
        publisher = client.node.create_publisher(String, f"/{namespace}/robot_description", latched)
        publisher.publish(String(data=text))
    left = viewer.seen(lambda s: s.descriptions.get("/left/robot_description"))
    assert left.namespace == "/left"
    assert [joint.name for joint in left.robot.joints] == ["turn", "grip"]
    right = viewer.seen(lambda s: s.descriptions.get("/right/robot_description"))
    assert right.robot is None
    assert "no links" in right.problem


def test_transforms_are_kept_and_those_that_are_none_left_out(client, viewer):
    from geometry_msgs.msg import TransformStamped
    from tf2_msgs.msg import TFMessage

    good, broken = TransformStamped(), TransformStamped()
    good.header.frame_id, good.child_frame_id = "base", "arm"
    good.transform.translation.z = 0.5
    broken.header.frame_id, broken.child_frame_id = "base", "finger"
    broken.transform.translation.x = float("nan")
    publisher = client.node.create_publisher(TFMessage, "/tf", 10)
    message = TFMessage(transforms=[broken, good])
    arm = viewer.seen(lambda s: s.transforms.get("arm"), lambda: publisher.publish(message))
    assert (arm.parent, arm.position) == ("base", (0.0, 0.0, 0.5))
    assert "finger" not in viewer.node.latest().transforms


def test_frames_are_the_same_with_a_slash_before_their_names(client, viewer, latched):
    from geometry_msgs.msg import TransformStamped
    from sensor_msgs.msg import CameraInfo
    from tf2_msgs.msg import TFMessage
    from visualization_msgs.msg import Marker, MarkerArray

    good, itself = TransformStamped(), TransformStamped()
    good.header.frame_id, good.child_frame_id = "/odom", "/slashed/base"
    itself.header.frame_id, itself.child_frame_id = "/odom", "odom"
    transforms = client.node.create_publisher(TFMessage, "/tf", 10)
    message = TFMessage(transforms=[itself, good])
    base = viewer.seen(
        lambda s: s.transforms.get("slashed/base"), lambda: transforms.publish(message)
    )
    assert base.parent == "odom"
    assert "odom" not in viewer.node.latest().transforms

    marker = Marker(ns="slashed", type=Marker.CUBE)
    marker.header.frame_id = "/odom"
    markers = client.node.create_publisher(MarkerArray, "/world_markers", latched)
    markers.publish(MarkerArray(markers=[marker]))
    shown = viewer.seen(lambda s: s.markers.get("/world_markers/slashed/0"))
    assert shown.frame == "odom"
    markers.publish(MarkerArray(markers=[Marker(action=Marker.DELETEALL)]))
    viewer.seen(lambda s: not s.markers)

    info = CameraInfo(width=4, height=2, k=[3.0, 0.0, 2.0, 0.0, 5.0, 1.0, 0.0, 0.0, 1.0])
    info.header.frame_id = "/optical"
    cameras = client.node.create_publisher(CameraInfo, "/slashed/camera_info", 10)
    view = viewer.seen(
        lambda s: s.cameras.get("/slashed/camera_info"), lambda: cameras.publish(info)
    )
    assert view.frame == "optical"


def test_joint_states_need_not_say_everything(client, viewer):
    from sensor_msgs.msg import JointState

    publisher = client.node.create_publisher(JointState, "/other/joint_states", 10)
    message = JointState(name=["a", "b"], position=[1.0, 2.0], velocity=[3.0])
    states = viewer.seen(
        lambda s: s.joint_states.get("/other/joint_states"), lambda: publisher.publish(message)
    )
    assert states.joints["b"].position == 2.0
    assert np.isnan(states.joints["a"].velocity)


def test_images_are_subscribed_to_only_while_they_are_wanted(client, viewer):
    from sensor_msgs.msg import Image

    from arm_viewer.requests import ShowPictures

    publisher = client.node.create_publisher(Image, "/camera/image", 10)
    viewer.seen(lambda s: "/camera/image" in s.image_topics)
    assert publisher.get_subscription_count() == 0
    viewer.node.send(ShowPictures(frozenset({"/camera/image"})))
    message = Image(width=2, height=1, step=6, encoding="rgb8", data=bytes(range(6)))
    picture = viewer.seen(
        lambda s: s.pictures.get("/camera/image"), lambda: publisher.publish(message)
    )
    assert (picture.width, picture.height, picture.encoding) == (2, 1, "rgb8")
    assert picture.data.tolist() == list(range(6))
    viewer.node.send(ShowPictures(frozenset()))
    viewer.until(lambda: publisher.get_subscription_count() == 0)
    viewer.seen(lambda s: not s.pictures)


def test_cameras_are_known_by_their_intrinsics_unless_these_say_nothing(client, viewer):
    from sensor_msgs.msg import CameraInfo

    from arm_viewer.snapshot import CameraView

    good = CameraInfo(width=4, height=2, k=[3.0, 0.0, 2.0, 0.0, 5.0, 1.0, 0.0, 0.0, 1.0])
    good.header.frame_id = "optical"
    told = {"/eye/camera_info": good, "/blind/camera_info": CameraInfo(width=4, height=2)}
    publishers = {t: client.node.create_publisher(CameraInfo, t, 10) for t in told}

    def tell() -> None:
        for topic, message in told.items():
            publishers[topic].publish(message)

    view = viewer.seen(lambda s: s.cameras.get("/eye/camera_info"), tell)
    assert view == CameraView("optical", 4, 2, (3.0, 5.0), (2.0, 1.0))
    assert "/blind/camera_info" not in viewer.node.latest().cameras
    client.node.destroy_publisher(publishers["/eye/camera_info"])
    viewer.seen(lambda s: "/eye/camera_info" not in s.cameras)


def test_markers_come_and_go(client, viewer, latched):
    from geometry_msgs.msg import Vector3
    from visualization_msgs.msg import Marker, MarkerArray

    from arm_viewer.snapshot import MarkerShape

    def box(number, action=Marker.ADD):
        marker = Marker(ns="crate", id=number, type=Marker.CUBE, action=action)
        marker.header.frame_id = "world"
        marker.pose.orientation.w = 2.0
        marker.scale = Vector3(x=1.0, y=2.0, z=3.0)
        return marker

    publisher = client.node.create_publisher(MarkerArray, "/world_markers", latched)
    publisher.publish(MarkerArray(markers=[box(1), box(2), Marker(ns="text", type=9)]))
    markers = viewer.seen(lambda s: s.markers)
    assert markers.keys() == {"/world_markers/crate/1", "/world_markers/crate/2"}
    marker = markers["/world_markers/crate/1"]
    assert (marker.look.shape, marker.look.scale) == (MarkerShape.BOX, (1.0, 2.0, 3.0))
    assert marker.rotation == (0.0, 0.0, 0.0, 1.0)
    publisher.publish(MarkerArray(markers=[box(1, Marker.DELETE)]))
    viewer.seen(lambda s: s.markers.keys() == {"/world_markers/crate/2"})


def test_without_a_robot_the_sliders_publish_its_joint_states(client, viewer, latched):
    from sensor_msgs.msg import JointState
    from std_msgs.msg import String

    from arm_viewer.requests import MoveJoints

    states = client.subscribe(JointState, "/joint_states")
    publisher = client.node.create_publisher(String, "/robot_description", latched)
    publisher.publish(String(data=URDF))
    viewer.until(lambda: list(states.messages))
    assert viewer.node.latest().displayed == {""}
    viewer.node.send(MoveJoints("", {"turn": 0.25}))
    viewer.until(lambda: states.messages[-1].position.tolist() == [0.25, 0.5])
    shown = viewer.seen(
        lambda s: (t := s.joint_states.get("/joint_states")) and t.joints["turn"].position == 0.25
    )
    assert shown
