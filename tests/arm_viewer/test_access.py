"""The requests that the page accepts, and what tokens give."""

import socket

import pytest
from websockets.datastructures import Headers

from arm_viewer.access import Access, Role, has_token, without_token
from arm_viewer.errors import PageError

PAGE = "127.0.0.1:8080"
COOKIE = "arm_page_8080"
LOCAL = Access()
OPEN = Access.on("0.0.0.0")


def reason_to_refuse(hosts, origins):
    return LOCAL.reason_to_refuse(hosts, origins)


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


@pytest.mark.parametrize("host", [PAGE, "192.168.1.7:8080", "[fe80::1]:8080", socket.gethostname()])
def test_a_page_for_other_machines_is_opened_by_its_addresses_and_name(host):
    assert OPEN.reason_to_refuse([host], [f"http://{host}"]) is None


@pytest.mark.parametrize("host", ["evil.example:8080", "robot.evil.example", "", "1.2.3.4.evil"])
def test_a_page_for_other_machines_refuses_other_names_too(host):
    assert "not for" in OPEN.reason_to_refuse([host], [f"http://{host}"])


def test_a_page_for_other_machines_refuses_foreign_origins_too():
    assert "may not use" in OPEN.reason_to_refuse(["192.168.1.7"], ["http://192.168.1.8"])


def test_this_machine_alone_needs_no_token():
    assert LOCAL.role("/", Headers(), COOKIE) is Role.USER
    assert Access.on("127.0.0.1").role("/", Headers(), COOKIE) is Role.USER
    assert Access.on("localhost", is_read_only=True).role("/", Headers(), COOKIE) is Role.VIEWER


def test_two_pages_have_different_tokens():
    tokens = {OPEN.token, OPEN.read_only_token, Access.on("0.0.0.0").token}
    assert len(tokens) == 3
    assert all(len(token) > 20 for token in tokens)


def test_tokens_that_are_named_are_the_same_after_a_restart():
    first, again = (Access.on("0.0.0.0", token="a-token_of-16-chars") for _ in range(2))
    assert first == again
    assert first.role_of("a-token_of-16-chars") is Role.USER
    assert first.role_of(first.read_only_token) is Role.VIEWER
    looking = Access.on("0.0.0.0", is_read_only=True, token="a-token_of-16-chars")
    assert looking.role_of("a-token_of-16-chars") is Role.STRANGER
    assert looking.role_of(first.read_only_token) is Role.VIEWER


@pytest.mark.parametrize("token", ["short", "with a space in it", "a&b=c&d=e&f=g&h=i", "x" * 129])
def test_a_token_that_is_easy_to_guess_or_fits_into_no_address_is_refused(token):
    with pytest.raises(PageError, match="ARM_VIEW_TOKEN is not 16 to 128 letters"):
        Access.on("0.0.0.0", token=token)


@pytest.mark.parametrize("path", ["/", "/?token=", "/?token=x", "/?token=\u00e4", "/?tokens=1"])
def test_without_a_valid_token_nobody_gets_in(path):
    assert OPEN.role(path, Headers(), COOKIE) is Role.STRANGER


def test_a_token_is_taken_from_the_address_or_from_the_cookie():
    for token, role in ((OPEN.token, Role.USER), (OPEN.read_only_token, Role.VIEWER)):
        assert OPEN.role(f"/?a=b&token={token}", Headers(), COOKIE) is role
        kept = Headers(Cookie=f"other=1; {COOKIE}={token}")
        assert OPEN.role("/", kept, COOKIE) is role
        assert OPEN.role("/", kept, "arm_page_9") is Role.STRANGER


def test_the_address_counts_before_the_cookie():
    kept = Headers(Cookie=f"{COOKIE}={OPEN.token}")
    assert OPEN.role(f"/?token={OPEN.read_only_token}", kept, COOKIE) is Role.VIEWER
    assert OPEN.role("/?token=old", kept, COOKIE) is Role.USER


def test_no_token_of_a_read_only_page_gives_more_than_looking():
    page = Access.on("0.0.0.0", is_read_only=True)
    assert page.role_of(page.read_only_token) is Role.VIEWER
    assert page.role_of(page.token) is Role.STRANGER


def test_the_token_leaves_the_address_and_the_rest_stays():
    assert has_token("/?token=x")
    assert without_token("//evil.example/?token=x") == "/"
    assert without_token("/?fixedDpr=1&token=x") == "/?fixedDpr=1"
