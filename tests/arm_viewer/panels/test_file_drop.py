"""Parts of files from browsers, honest and forged."""

import base64

import pytest
from fake_channel import FakeBrowser, FakeChannel

from arm_viewer.channel import Message
from arm_viewer.errors import BrowserMessageError
from arm_viewer.panels.file_drop import FileDrop
from arm_viewer.world.dropped_file import MAX_BYTES, DroppedFile


class Drop:
    """The drop with everything around it."""

    def __init__(self):
        channel, self.browser, self.taken = FakeChannel(), FakeBrowser(), []
        self.drop = FileDrop(channel, self.taken.append)
        self.handler = channel.handlers["file_part"]

    def part(self, data, offset=0, size=6, name="a.stl"):
        fields = {
            "name": name,
            "size": size,
            "offset": offset,
            "data": base64.b64encode(data).decode(),
        }
        self.handler(Message("file_part", fields), self.browser)


@pytest.fixture
def drop():
    return Drop()


def test_parts_become_a_file(drop):
    drop.part(b"abcd")
    assert drop.taken == []
    drop.part(b"ef", 4)
    assert drop.taken == [DroppedFile("a.stl", b"abcdef")]
    assert drop.browser.told[-1] == {"name": "a.stl", "bytes": 6, "of": 6}


@pytest.mark.parametrize(("data", "offset"), [(b"x", 3), (b"xyz", 4), (b"x", -1), (b"x", 1e300)])
def test_a_part_that_does_not_follow_ends_the_file(drop, data, offset):
    drop.part(b"abcd")
    with pytest.raises(BrowserMessageError, match="drop it again"):
        drop.part(data, offset)
    with pytest.raises(BrowserMessageError, match="drop it again"):
        drop.part(b"ef", 4)
    assert drop.taken == []


@pytest.mark.parametrize(("name", "size"), [("a.exe", 6), ("a.stl", MAX_BYTES + 1), ("a.stl", 0)])
def test_what_may_not_come_is_refused_at_its_first_part(drop, name, size):
    with pytest.raises(BrowserMessageError, match=name):
        drop.part(b"abcd", name=name, size=size)


def test_what_is_not_base_64_is_refused(drop):
    fields = {"name": "a.stl", "size": 6, "offset": 0, "data": "!"}
    with pytest.raises(BrowserMessageError, match="not base 64"):
        drop.handler(Message("file_part", fields), drop.browser)


def test_a_browser_that_leaves_takes_its_parts_along(drop):
    drop.part(b"abcd")
    drop.browser.is_connected = False
    drop.drop.forget_the_gone()
    with pytest.raises(BrowserMessageError, match="drop it again"):
        drop.part(b"ef", 4)
