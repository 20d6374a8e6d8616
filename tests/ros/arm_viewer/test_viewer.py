"""What the page's node makes of topics, and what it publishes; without a page."""

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import Point, TransformStamped, Vector3
from pal_statistics_msgs.msg import Statistic, Statistics
from sensor_msgs.msg import CameraInfo, Image, JointState
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from arm_description.urdf.description_source import with_source
from arm_viewer.requests import ListNumbers, MoveJoints, PlotCurves, ShowContacts, ShowPictures
from arm_viewer.snapshot import CameraView, MarkerShape

URDF = """<robot name='r'><link name='base'/><link name='arm'/><link name='finger'/>
  <joint name='turn' type='revolute'><parent link='base'/><child link='arm'/>
    <limit lower='-1' upper='1' effort='1' velocity='1'/></joint>
  <joint name='grip' type='revolute'><parent link='arm'/><child link='finger'/>
    <limit lower='-3' upper='3' effort='1' velocity='1'/><mimic joint='turn' multiplier='2'/>
  </joint></robot>"""


def test_robots_are_found_in_every_namespace(client, viewer, latched):
    for namespace, text in (("left", URDF), ("right", "<robot name='r'/>")):
        publisher = client.node.create_publisher(String, f"/{namespace}/robot_description", latched)
        publisher.publish(String(data=text))
    left = viewer.seen(lambda s: s.descriptions.get("/left/robot_description"))
    assert left.namespace == "/left"
    assert [joint.name for joint in left.robot.joints] == ["turn", "grip"]
    right = viewer.seen(lambda s: s.descriptions.get("/right/robot_description"))
    assert right.robot is None
    assert "no links" in right.problem


def test_each_robots_meshes_are_found_where_its_description_comes_from(
    client, viewer, latched, tmp_path
):
    uris = ("../meshes/a.stl", "package://arm_description/meshes/a.stl")
    shapes = "".join(
        f"<visual><geometry><mesh filename='{uri}'/></geometry></visual>" for uri in uris
    )
    text = f"<robot name='r'><link name='base'>{shapes}</link></robot>"
    for namespace in ("west", "east"):
        package = tmp_path / namespace
        (package / "meshes").mkdir(parents=True)
        (package / "meshes/a.stl").touch()
        (package / "package.xml").write_text("<package><name>arm_description</name></package>")
        publisher = client.node.create_publisher(String, f"/{namespace}/robot_description", latched)
        publisher.publish(String(data=with_source(text, package / "urdf/arm.urdf")))
    for namespace in ("west", "east"):
        seen = viewer.seen(
            lambda s, topic=f"/{namespace}/robot_description": s.descriptions.get(topic)
        )
        meshes = {visual.geometry.uri for visual in seen.robot.links[0].visuals}
        assert meshes == {str(tmp_path / namespace / "meshes/a.stl")}


def test_transforms_are_kept_and_invalid_ones_left_out(client, viewer):
    good, broken = TransformStamped(), TransformStamped()
    good.header.frame_id, good.child_frame_id = "base", "arm"
    good.transform.translation.z = 0.5
    broken.header.frame_id, broken.child_frame_id = "base", "finger"
    broken.transform.translation.x = float("nan")
    publisher = client.node.create_publisher(TFMessage, "/tf", 10)
    message = TFMessage(transforms=[broken, good])
    arm = viewer.seen(lambda s: s.transforms.get("arm"), lambda: publisher.publish(message))
    assert (arm.parent, arm.pose.position) == ("base", (0.0, 0.0, 0.5))
    assert "finger" not in viewer.node.latest().transforms


def test_frames_are_the_same_with_a_slash_before_their_names(client, viewer, latched):
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
    publisher = client.node.create_publisher(JointState, "/other/joint_states", 10)
    message = JointState(name=["a", "b"], position=[1.0, 2.0], velocity=[3.0])
    states = viewer.seen(
        lambda s: s.joint_states.get("/other/joint_states"), lambda: publisher.publish(message)
    )
    assert states.joints["b"].position == 2.0
    assert np.isnan(states.joints["a"].velocity)


def test_images_are_subscribed_to_only_while_they_are_wanted(client, viewer):
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
    assert marker.pose.rotation == (0.0, 0.0, 0.0, 1.0)
    publisher.publish(MarkerArray(markers=[box(1, Marker.DELETE)]))
    viewer.seen(lambda s: s.markers.keys() == {"/world_markers/crate/2"})


def test_contacts_are_subscribed_to_while_they_are_shown(client, viewer, latched):
    points = Marker(type=Marker.SPHERE_LIST, points=[Point(x=1.0)])
    points.header.frame_id = "world"
    forces = Marker(type=Marker.LINE_LIST, points=[Point(x=1.0), Point(z=2.0)], text="a on b: 1 N")
    publisher = client.node.create_publisher(MarkerArray, "/contact_markers", latched)
    publisher.publish(MarkerArray(markers=[points, forces]))
    assert viewer.node.latest().contacts is None
    assert publisher.get_subscription_count() == 0
    viewer.node.send(ShowContacts(True))
    shown = viewer.seen(lambda s: s.contacts)
    assert (shown.frame, shown.strongest) == ("world", ("a on b: 1 N",))
    assert shown.points.tolist() == [[1.0, 0.0, 0.0]]
    assert shown.lines.tolist() == [[[1.0, 0.0, 0.0], [0.0, 0.0, 2.0]]]
    points.action = forces.action = Marker.DELETE
    publisher.publish(MarkerArray(markers=[points, forces]))
    viewer.seen(lambda s: s.contacts is not None and not len(s.contacts.points))
    viewer.node.send(ShowContacts(False))
    viewer.seen(lambda s: s.contacts is None)
    # Of a subscription that was short the publisher's own count may tell nothing.
    viewer.until(lambda: client.node.count_subscribers("/contact_markers") == 0)


def transform(child, parent="base"):
    stamped = TransformStamped(child_frame_id=child)
    stamped.header.frame_id = parent
    return stamped


def test_data_without_a_publisher_is_removed(client, viewer, latched):
    marker = Marker(ns="crate", type=Marker.CUBE)
    marker.header.frame_id = "world"
    states = JointState(name=["turn"], position=[1.0])
    said = {
        "/gone/robot_description": (String, String(data=URDF), latched),
        "/gone/joint_states": (JointState, states, 10),
        "/gone/world_markers": (MarkerArray, MarkerArray(markers=[marker]), latched),
        "/tf": (TFMessage, TFMessage(transforms=[transform("gone_arm")]), 10),
        "/tf_static": (TFMessage, TFMessage(transforms=[transform("gone_base")]), latched),
    }
    publishers = {
        topic: client.node.create_publisher(message_class, topic, qos)
        for topic, (message_class, _, qos) in said.items()
    }

    def say() -> None:
        for topic, publisher in publishers.items():
            publisher.publish(said[topic][1])

    def is_shown(snapshot) -> list[bool]:
        return [
            "/gone/robot_description" in snapshot.descriptions,
            "/gone/joint_states" in snapshot.joint_states,
            "/gone/world_markers/crate/0" in snapshot.markers,
            "gone_arm" in snapshot.transforms,
            "gone_base" in snapshot.transforms,
        ]

    viewer.seen(lambda s: all(is_shown(s)), say)
    for publisher in publishers.values():
        client.node.destroy_publisher(publisher)
    viewer.seen(lambda s: not any(is_shown(s)))
    assert {"/gone/robot_description", "/gone/joint_states"} <= viewer.node.latest().lost


def test_what_others_still_publish_stays_when_one_goes(client, viewer, latched):
    def markers(name):
        marker = Marker(ns=name, type=Marker.CUBE)
        marker.header.frame_id = "world"
        return MarkerArray(markers=[marker])

    def joint_states(name):
        return JointState(name=[name], position=[1.0])

    def static(name):
        return TFMessage(transforms=[transform(name)])

    made = {
        "/shared/world_markers": (MarkerArray, markers, latched),
        "/shared/joint_states": (JointState, joint_states, 10),
        "/tf_static": (TFMessage, static, latched),
    }
    publishers = {
        (name, topic): client.node.create_publisher(message_class, topic, qos)
        for topic, (message_class, _, qos) in made.items()
        for name in ("stays", "goes")
    }
    for (name, topic), publisher in publishers.items():
        publisher.publish(made[topic][1](name))

    def go_on(*names) -> None:
        for name in names:
            publishers[name, "/shared/joint_states"].publish(joint_states(name))

    def shown(snapshot) -> set[str]:
        joints = snapshot.joint_states.get("/shared/joint_states")
        return {
            *(name.split("/")[3] for name in snapshot.markers if "/shared/" in name),
            *(f"{name} joint" for name in (joints.joints if joints else ())),
            *(f"{name} frame" for name in snapshot.transforms if name in ("stays", "goes")),
        }

    stays = {"stays", "stays joint", "stays frame"}
    goes = {"goes", "goes joint", "goes frame"}
    viewer.seen(lambda s: shown(s) == stays | goes, lambda: go_on("stays", "goes"))
    for topic in made:
        client.node.destroy_publisher(publishers["goes", topic])
    viewer.seen(lambda s: shown(s) == stays, lambda: go_on("stays"))
    assert shown(viewer.node.latest()) == stays


def test_frames_of_a_former_description_are_forgotten(client, viewer, latched):
    statics = client.node.create_publisher(TFMessage, "/tf_static", latched)
    descriptions = client.node.create_publisher(String, "/changed/robot_description", latched)
    statics.publish(TFMessage(transforms=[transform("old_link"), transform("kept_link")]))
    descriptions.publish(String(data=URDF))
    viewer.seen(
        lambda s: "old_link" in s.transforms and "/changed/robot_description" in s.descriptions
    )
    statics.publish(TFMessage(transforms=[transform("kept_link"), transform("new_link")]))
    descriptions.publish(String(data=URDF.replace("name='r'", "name='other'")))
    viewer.seen(lambda s: {"kept_link", "new_link"} <= s.transforms.keys())
    viewer.seen(lambda s: "old_link" not in s.transforms)
    assert {"kept_link", "new_link"} <= viewer.node.latest().transforms.keys()


def test_without_a_robot_the_sliders_publish_its_joint_states(client, viewer, latched):
    states = client.subscribe(JointState, "/joint_states")
    publisher = client.node.create_publisher(String, "/robot_description", latched)
    publisher.publish(String(data=URDF))
    viewer.until(lambda: list(states.messages))
    # Those of earlier tests may still be found.
    viewer.seen(lambda s: s.displayed == {""})
    viewer.node.send(MoveJoints("", {"turn": 0.25}))
    viewer.until(lambda: states.messages[-1].position.tolist() == [0.25, 0.5])
    shown = viewer.seen(
        lambda s: (t := s.joint_states.get("/joint_states")) and t.joints["turn"].position == 0.25
    )
    assert shown


def test_without_joint_states_positions_come_from_the_controller_manager(client, viewer):
    publisher = client.node.create_publisher(
        Statistics, "/limp/controller_manager/introspection_data/full", 10
    )
    values = {
        "state_interface.j0/position": 0.5,
        "state_interface.j0/velocity": 0.1,
        "state_interface.j1/position": float("nan"),
        "command_interface.j0/position": 0.0,
    }
    message = Statistics(statistics=[Statistic(name=n, value=v) for n, v in values.items()])
    read = viewer.seen(
        lambda s: s.hardware_positions.get("/limp"), lambda: publisher.publish(message)
    )
    assert read == {"j0": 0.5}
    states = client.node.create_publisher(JointState, "/limp/joint_states", 10)
    viewer.seen(lambda s: "/limp" not in s.hardware_positions)
    client.node.destroy_publisher(states)


def test_the_arm_without_controllers_falls_and_is_seen_to(launch, viewer):
    launch("arm_gazebo", "arm_world.launch.py", "camera:=none", "namespace:=fallen")
    assert viewer.seen(lambda s: s.hardware_positions.get("/fallen", {}).get("j1", 0.0) > 1.2)


def test_numbers_of_any_topic_are_found_and_their_samples_kept(client, viewer):
    publisher = client.node.create_publisher(JointState, "/plotted/states", 10)
    viewer.seen(lambda s: any(topic.name == "/plotted/states" for topic in s.topics))
    message = JointState(name=["a", "b"], position=[1.0, 2.5])
    viewer.node.send(ListNumbers())
    numbers = viewer.seen(
        lambda s: s.numbers.get("/plotted/states"), lambda: publisher.publish(message)
    )
    assert numbers == ("position[a]", "position[b]")
    name = "/plotted/states.position[b]"
    viewer.node.send(PlotCurves(frozenset({name})))
    values = viewer.seen(
        lambda s: s.curves.since(name, 0.0).values.tolist(), lambda: publisher.publish(message)
    )
    assert values[0] == 2.5
    viewer.node.send(PlotCurves(frozenset()))
    viewer.seen(lambda s: not len(s.curves.since(name, 0.0).values))
    viewer.until(lambda: publisher.get_subscription_count() == 0)


def test_what_nodes_log_and_diagnose_is_kept(client, viewer):
    status = DiagnosticStatus(
        level=b"\x01", name="motor: heat", message="warm", values=[KeyValue(key="T", value="60")]
    )
    diagnostics = client.node.create_publisher(DiagnosticArray, "/diagnostics", 10)
    heat = viewer.seen(
        lambda s: s.diagnoses.get("motor: heat"),
        lambda: diagnostics.publish(DiagnosticArray(status=[status])),
    )
    assert (heat.level, heat.text, heat.values) == (1, "warm", (("T", "60"),))
    client.node.get_logger().error("too hot")
    entry = viewer.seen(lambda s: next((e for e in s.log if e.text == "too hot"), None))
    assert (entry.level, entry.node) == (40, client.node.get_name())
    assert "test_viewer.py" in entry.place
