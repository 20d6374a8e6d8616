import socket

import pytest

from arm_node import ros_domain
from arm_node.ros_domain import DOMAINS, NoFreeDomainError, domain_of_its_own


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
