"""The recorder in this process, blocked so long that its queue overflows."""

import itertools
import time

from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message
from std_msgs.msg import String

from arm_cli.bag.ros_recorder import BagRecorder, Recording
from arm_cli.bag.topic_selection import TopicSelection
from arm_cli.bag_format.topic import BagMessage
from arm_cli.bag_format.writer import BagSettings, BagWriter
from arm_cli.errors import BagError
from arm_cli.ros.qos import RECORDING_DEPTH
from arm_cli.ros.session import open_session

TOPIC = "/stream"
TIMEOUT_S = 60.0


class HeldUp(Recording):
    """A recording that, when the recorder looks whether it failed, has messages sent to it.

    First one after the other, until one has come; then more than the queue holds, which the
    recorder cannot take meanwhile; then again one after the other, until one of these has come.
    """

    def __init__(self, writer: BagWriter, publisher) -> None:
        super().__init__(writer, 1 << 30)
        self.came: list[int] = []
        self._publisher = publisher
        self._numbers = itertools.count()
        self._flooded = 0
        self._deadline_s = time.monotonic() + TIMEOUT_S

    @property
    def failure(self) -> BagError | None:
        if time.monotonic() > self._deadline_s:
            return BagError(f"not within {TIMEOUT_S} s")
        if not self._flooded and self.came:
            for _ in range(RECORDING_DEPTH + 1000):
                self._flooded = self._send()
        if self._flooded and self.came[-1] > self._flooded:
            return BagError("that is enough")
        if self._publisher.get_subscription_count():
            self._send()
        return None

    def put(self, message: BagMessage) -> None:
        self.came.append(int(deserialize_message(message.data, String).data))
        super().put(message)

    def _send(self) -> int:
        number = next(self._numbers)
        self._publisher.publish(String(data=str(number)))
        return number


def test_messages_lost_by_a_full_queue_are_counted(client, tmp_path):
    publisher = client.node.create_publisher(String, TOPIC, QoSProfile(depth=1))
    selection = TopicSelection(names=frozenset({TOPIC}))
    recording = HeldUp(BagWriter(tmp_path / "bag", BagSettings()), publisher)
    with open_session() as session:
        recorder = BagRecorder(session, recording, selection, 0.1, use_sim_time=False)
        recorder.run()
    came = recording.came
    assert came == sorted(came)
    missing = came[-1] - came[0] + 1 - len(came)
    assert missing > 0
    assert recorder.lost == {TOPIC: missing}
    assert recording.finish().message_count == len(came)
