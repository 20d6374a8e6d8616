"""A recorded topic, and a message of it."""

from dataclasses import dataclass
from typing import NamedTuple

from arm_cli.bag.offered_qos import OfferedQos


@dataclass(frozen=True, slots=True)
class BagTopic:
    """What a bag knows of a topic.

    Attributes:
        name: absolute name.
        type: such as sensor_msgs/msg/JointState.
        type_hash: RIHS01_ and 64 hexadecimal digits; empty where nobody told it.
        offers: quality of service of its publishers when it was subscribed to.
        serialization_format: of its messages.
    """

    name: str
    type: str
    type_hash: str = ""
    offers: tuple[OfferedQos, ...] = ()
    serialization_format: str = "cdr"


class BagMessage(NamedTuple):
    """A serialized message. A tuple: one is made for every message that comes in.

    Attributes:
        topic: its name.
        log_time_ns: when it was received.
        publish_time_ns: when it was published.
        data: as on the wire, with the encapsulation header.
    """

    topic: str
    log_time_ns: int
    publish_time_ns: int
    data: bytes
