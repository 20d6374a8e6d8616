"""How long contacts that were received count."""

import math

from visualization_msgs.msg import MarkerArray

from arm_viewer.ros import contact_observer


class FakeTopics:
    """One topic, its next message, and the time before which what it brought is outdated."""

    def __init__(self, *_):
        self.message, self.outdated_s = None, -math.inf

    def readers(self):
        yield self

    def take_newest(self):
        message, self.message = self.message, None
        return message

    def outdated_before(self, now_s):
        return self.outdated_s

    def close(self):
        """End nothing."""


def test_contacts_stay_until_their_publisher_has_gone(monkeypatch):
    topics = FakeTopics()
    monkeypatch.setattr(contact_observer, "TopicGroup", lambda *_: topics)
    observer = contact_observer.ContactObserver(None, None)
    observer.show(True)
    observer.collect(1.0)
    assert observer.contacts is None
    topics.message, topics.outdated_s = MarkerArray(), 4.0
    observer.collect(5.0)
    observer.collect(6.0)
    assert observer.contacts is not None, "it was repeated after another publisher had gone"
    topics.outdated_s = 7.0
    observer.collect(8.0)
    assert observer.contacts is None
    topics.message = MarkerArray()
    observer.collect(9.0)
    observer.show(False)
    assert observer.contacts is None
