"""What one peer publishes amiss must not keep the page's node from what the others have."""

import pytest
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import Float64
from tf2_msgs.msg import TFMessage

from arm_viewer.requests import MeasureRates, ShowPictures
from arm_viewer.ros.command_observer import CommandObserver


@pytest.fixture
def stranger(client):
    """Another participant: none can have two types on one topic."""
    other = type(client)()
    yield other
    other.close()


def find_new_camera(viewer, client, topic):
    """Wait until a camera that is new is found."""
    info = CameraInfo(width=4, height=2, k=[3.0, 0.0, 2.0, 0.0, 5.0, 1.0, 0.0, 0.0, 1.0])
    info.header.frame_id = "optical"
    publisher = client.node.create_publisher(CameraInfo, topic, 10)
    viewer.seen(lambda s: topic in s.cameras, lambda: publisher.publish(info))
    viewer.seen(lambda s: topic in {known.name for known in s.topics})


def test_a_topic_of_two_types_is_left_out_alone_and_said_once(client, stranger, viewer, capfd):
    images = client.node.create_publisher(Image, "/clash/image", 10)
    viewer.seen(lambda s: "/clash/image" in s.image_topics)
    viewer.node.send(ShowPictures(frozenset({"/clash/image"})))
    viewer.until(lambda: images.get_subscription_count() == 1)
    stranger.node.create_publisher(CameraInfo, "/clash/image", 10)
    both = ("sensor_msgs/msg/CameraInfo", "sensor_msgs/msg/Image")
    viewer.seen(lambda s: both in {topic.types for topic in s.topics})
    find_new_camera(viewer, client, "/clash/first/camera_info")
    find_new_camera(viewer, client, "/clash/second/camera_info")
    image = Image(width=1, height=1, step=3, encoding="rgb8", data=bytes(3))
    viewer.seen(lambda s: "/clash/image" in s.pictures, lambda: images.publish(image))
    viewer.node.send(ShowPictures(frozenset()))
    said = capfd.readouterr().err
    assert said.count(f"/clash/image has several types ({', '.join(both)})") == 1
    assert "invalid allocator" not in said


def test_rates_are_measured_beside_a_topic_of_another_type(client, stranger, viewer):
    stranger.node.create_publisher(TransformStamped, "/tf", 10)
    publishers = {
        "/tf": (client.node.create_publisher(TFMessage, "/tf", 10), TFMessage()),
        "/zone": (client.node.create_publisher(Float64, "/zone", 10), Float64()),
    }
    viewer.seen(lambda s: any(t.name == "/tf" and len(t.types) == 2 for t in s.topics))
    viewer.node.send(MeasureRates(True))

    def publish() -> None:
        for publisher, message in publishers.values():
            publisher.publish(message)

    def rates(snapshot) -> dict[str, float]:
        return {topic.name: topic.rate_hz for topic in snapshot.topics if topic.rate_hz > 0.0}

    viewer.seen(lambda s: rates(s).keys() >= publishers.keys(), publish)
    viewer.node.send(MeasureRates(False))
    assert viewer.seen(lambda s: not rates(s))


def test_an_observer_that_fails_stops_no_other_and_is_named_once(
    client, viewer, monkeypatch, caplog
):
    tries = []

    def fail(observer, topics):
        tries.append(observer)
        raise RuntimeError("no such thing")

    monkeypatch.setattr(CommandObserver, "discover", fail)
    viewer.until(lambda: tries)
    find_new_camera(viewer, client, "/beside/camera_info")
    viewer.until(lambda: len(tries) > 2)
    assert [record.message for record in caplog.records] == [
        "CommandObserver failed: no such thing"
    ]
