"""How long a command stays so that its last messages arrive."""

import time
from dataclasses import dataclass, field

import pytest

from arm_cli.errors import UsageError
from arm_cli.names import absolute_name
from arm_cli.ros.session import ACKNOWLEDGED_WITHIN_S, open_session

pytestmark = pytest.mark.ros


@dataclass
class PublisherOf:
    """Stands for a publisher whose readers acknowledge late, or never."""

    readers: int
    acknowledged_after_s: float
    waited_s: list[float] = field(default_factory=list)

    def get_subscription_count(self) -> int:
        return self.readers

    def wait_for_all_acked(self, timeout) -> bool:
        self.waited_s.append(timeout.nanoseconds * 1e-9)
        time.sleep(min(self.acknowledged_after_s, self.waited_s[-1]))
        return self.acknowledged_after_s <= self.waited_s[-1]


def test_the_last_messages_are_waited_for_until_they_are_acknowledged():
    late, in_time, unread = PublisherOf(1, 0.2), PublisherOf(2, 0.0), PublisherOf(0, 0.0)
    with open_session() as session:
        session.let_arrive([late, in_time, unread], 0.01)
    assert late.waited_s == [pytest.approx(ACKNOWLEDGED_WITHIN_S, abs=0.1)]
    assert len(in_time.waited_s) == 1
    assert in_time.waited_s[0] <= ACKNOWLEDGED_WITHIN_S - 0.2
    assert unread.waited_s == []


def test_readers_that_never_acknowledge_are_waited_for_no_longer_than_a_second_in_all():
    first, second = PublisherOf(1, float("inf")), PublisherOf(1, float("inf"))
    with open_session() as session:
        session.let_arrive([first, second], 0.01)
    assert len(first.waited_s) == 1
    assert sum(first.waited_s + second.waited_s) <= ACKNOWLEDGED_WITHIN_S


@pytest.mark.parametrize("name", ["my topic", "/7th", "/", "/a//b", "/a{b}", "~/a"])
def test_a_name_that_nothing_in_ros_can_have_is_one_sentence(name):
    with pytest.raises(UsageError) as error, open_session() as session:
        session.full_name(name)
    assert str(error.value).startswith(f"'{absolute_name(name)}': Invalid topic name: topic name")
    assert not {"\n", "^"} & set(str(error.value))
    assert str(error.value)[-1] != ":"


def test_a_name_that_no_node_can_have_is_one_sentence():
    with pytest.raises(UsageError, match=r"^'a b': Invalid node name: "), open_session("a b"):
        pass


def test_a_name_is_completed_as_the_graph_has_it():
    with open_session() as session:
        assert session.full_name("_hidden/joint_states") == "/_hidden/joint_states"
        assert session.full_name("/tf") == "/tf"
