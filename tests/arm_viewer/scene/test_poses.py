"""How poses of scene nodes reach browsers: by frames of the channel, or by viser."""

from dataclasses import dataclass, field
from types import SimpleNamespace

import pytest

from arm_node.rigid_transform import RigidTransform
from arm_viewer.channel import Message
from arm_viewer.scene.poses import ASKED, FRAME, NAMES, REST_S, ROW, Poses

HOME = RigidTransform((0.5, 0.0, 0.25))
AWAY = RigidTransform((1.0, 2.0, 3.0), (0.0, 0.0, 1.0, 0.0))


@dataclass
class Wire:
    """A channel that keeps what is sent, and the browsers that viser serves."""

    handlers: dict = field(default_factory=dict)
    frames: list = field(default_factory=list)
    names: list = field(default_factory=list)
    browsers: int = 0

    def on(self, kind, handler, *, changes) -> None:
        self.handlers[kind] = handler

    def send(self, kind, fields, *, keep=False) -> None:
        assert kind == NAMES
        assert keep
        self.names = fields["names"]

    def send_bytes(self, kind, payload) -> None:
        assert kind == FRAME
        rows = (ROW.unpack_from(payload, at) for at in range(0, len(payload), ROW.size))
        self.frames.append({self.names[int(row[0])]: row[1:] for row in rows})

    def ask(self) -> SimpleNamespace:
        """Let a browser's script ask for frames."""
        browser = SimpleNamespace(is_connected=True)
        self.handlers[ASKED](Message(ASKED, {}), browser)
        return browser


@pytest.fixture
def wire() -> Wire:
    return Wire()


@pytest.fixture
def poses(wire) -> Poses:
    return Poses(wire, lambda: wire.browsers)


def node(name: str) -> SimpleNamespace:
    return SimpleNamespace(name=name, position=None, wxyz=None)


def test_a_new_node_is_at_its_place_at_once(poses):
    link = node("/frames/link")
    poses.move(link, AWAY)
    assert link.position == (1.0, 2.0, 3.0)
    assert link.wxyz == (0.0, 0.0, 0.0, 1.0)


def test_a_browser_that_asked_gets_frames_and_viser_nothing_until_rest(poses, wire):
    link = node("/frames/link")
    poses.move(link, HOME)
    wire.browsers = 1
    wire.ask()
    poses.send(1.0)
    poses.move(link, AWAY)
    poses.send(1.0)
    assert wire.frames[-1] == {"/frames/link": (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0)}
    assert link.position == HOME.position
    poses.send(1.0 + REST_S + 0.1)
    assert link.position == AWAY.position
    assert len(wire.frames) == 2


def test_only_what_moved_is_sent(poses, wire):
    links = [node(f"/frames/{i}") for i in range(3)]
    for link in links:
        poses.move(link, HOME)
    wire.ask()
    poses.send(1.0)
    assert set(wire.frames[0]) == {"/frames/0", "/frames/1", "/frames/2"}
    poses.move(links[1], AWAY)
    poses.send(1.1)
    poses.send(1.2)
    assert [set(frame) for frame in wire.frames[1:]] == [{"/frames/1"}]


def test_a_browser_that_has_not_asked_is_served_by_viser(poses, wire):
    link = node("/frames/link")
    poses.move(link, HOME)
    asker = wire.ask()
    wire.browsers = 2
    poses.move(link, AWAY)
    poses.send(1.0)
    assert link.position == AWAY.position
    wire.browsers = 1
    poses.move(link, HOME)
    poses.send(1.1)
    assert link.position == AWAY.position
    asker.is_connected = False
    poses.send(1.2)
    assert link.position == HOME.position


def test_a_browser_that_asks_later_gets_every_pose(poses, wire):
    for name in ("a", "b"):
        poses.move(node(name), AWAY)
    poses.send(1.0)
    assert wire.frames == []
    wire.ask()
    poses.send(9.0)
    assert set(wire.frames[0]) == {"a", "b"}


def test_a_removed_node_is_not_moved_any_more(poses, wire):
    kept, gone = node("kept"), node("gone")
    for link in (gone, kept):
        poses.move(link, HOME)
    wire.ask()
    poses.send(1.0)
    poses.move(gone, AWAY)
    poses.forget(gone)
    poses.move(kept, AWAY)
    poses.send(1.1)
    assert wire.names == ["kept"]
    assert set(wire.frames[-1]) == {"kept"}
    poses.send(9.0)
    assert gone.position == HOME.position
