"""The requests that the page accepts."""

import pytest

from arm_viewer.page_server import reason_to_refuse

PAGE = "127.0.0.1:8080"


@pytest.mark.parametrize(
    ("host", "origins"),
    [
        (PAGE, [f"http://{PAGE}"]),
        ("localhost:8080", ["http://localhost:8080"]),
        ("localhost", ["http://localhost"]),
        ("[::1]:9000", ["http://[::1]:9000"]),
        (PAGE, []),
    ],
    ids=["address", "name", "port 80", "tunnel", "no browser"],
)
def test_the_page_itself_and_programs_pass(host, origins):
    assert reason_to_refuse([host], origins) is None


@pytest.mark.parametrize(
    "origins",
    [
        ["http://evil.example"],
        ["http://127.0.0.1:3000"],
        ["http://localhost:8080"],
        [f"https://{PAGE}"],
        [f"http://{PAGE}.evil.example"],
        ["null"],
        [""],
        [f"http://{PAGE}", "http://evil.example"],
    ],
)
def test_a_foreign_origin_is_refused(origins):
    reason = reason_to_refuse([PAGE], origins)
    assert reason is not None
    assert f"may not use this one, which is http://{PAGE}" in reason


@pytest.mark.parametrize(
    "hosts",
    [
        ["evil.example:8080"],
        ["127.0.0.1.evil.example:8080"],
        ["localhost.evil.example"],
        ["evil.example@127.0.0.2"],
        ["[::1"],
        [""],
        [],
        [PAGE, "evil.example"],
    ],
)
def test_a_name_that_is_not_this_machines_is_refused_though_the_origin_agrees(hosts):
    reason = reason_to_refuse(hosts, [f"http://{host}" for host in hosts])
    assert reason is not None
    assert "only for this machine" in reason
