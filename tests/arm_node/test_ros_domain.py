import os
import socket

import pytest

from arm_node import ros_domain
from arm_node.ros_domain import (
    DOMAINS,
    NoFreeDomainError,
    describe_users,
    domain_of_its_own,
    other_users,
)


def test_whoever_asks_gets_another_domain():
    with domain_of_its_own() as one, domain_of_its_own() as other:
        assert one != other
        assert {one, other} <= set(DOMAINS)


def test_a_domain_in_which_something_listens_is_not_free(monkeypatch, tmp_path):
    monkeypatch.setattr(ros_domain.tempfile, "gettempdir", lambda: str(tmp_path))
    with domain_of_its_own() as domain:
        pass
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listening:
        listening.bind(("127.0.0.1", 7400 + 250 * domain + 10))
        with domain_of_its_own() as other:
            assert other != domain


def test_without_a_free_domain_there_is_a_sentence(monkeypatch, tmp_path):
    monkeypatch.setattr(ros_domain.tempfile, "gettempdir", lambda: str(tmp_path))
    monkeypatch.setattr(ros_domain, "DOMAINS", range(1, 2))
    # Another test may listen in that domain.
    monkeypatch.setattr(ros_domain, "_busy_domains", set)
    with (
        domain_of_its_own(),
        pytest.raises(NoFreeDomainError, match="all ROS domains from 1 to 1 are in use"),
        domain_of_its_own(),
    ):
        pass


def test_a_folder_of_locks_that_cannot_be_used_is_named(monkeypatch, tmp_path):
    monkeypatch.setattr(ros_domain.tempfile, "gettempdir", lambda: str(tmp_path))
    folder = tmp_path / f"ros-domains-{os.getuid()}"
    folder.touch()
    sentence = rf"cannot reserve a ROS domain in {folder}: File exists; remove it, or set TMPDIR"
    with pytest.raises(NoFreeDomainError, match=sentence), domain_of_its_own():
        pass


@pytest.fixture
def table(tmp_path):
    """Return a function that writes a file like /proc/net/udp from ports and users."""

    def write(*rows: tuple[int, int]):
        lines = [
            f"1: 0100007F:{port:04X} 00000000:0000 07 00000000:00000000 00:00000000 00000000 "
            f"{user} 0 4711 2"
            for port, user in rows
        ]
        path = tmp_path / "udp"
        path.write_text("\n".join(["  sl  local_address", *lines, ""]))
        return path

    return write


def test_other_users_in_a_domain_are_named(table):
    me, other = os.getuid(), 4_000_000
    path = table((7410, me), (7412, other), (7660, other + 1), (53, other + 2))
    assert other_users(0, path) == [f"with id {other}"]
    assert other_users(1, path) == [f"with id {other + 1}"]
    assert other_users(2, path) == []


def test_this_user_alone_is_no_other_user(table):
    assert other_users(0, table((7410, os.getuid()))) == []


def test_a_multicast_port_or_a_port_of_the_system_tells_nothing(table):
    other = os.getuid() + 1
    assert other_users(0, table((7400, other))) == []
    assert other_users(150, table((7400 + 250 * 150 + 10, other))) == []


@pytest.mark.parametrize(
    ("users", "start"),
    [(["anna"], "user anna runs ROS programs"), (["anna", "ben"], "users anna, ben run ROS")],
)
def test_the_sentence_about_other_users(users, start):
    assert describe_users(users).startswith(start)
