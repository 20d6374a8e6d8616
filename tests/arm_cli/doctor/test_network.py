"""`arm doctor` checks the network: discovery, ports, the page's port and listening programs."""

import contextlib
import os
import socket
import sys
import threading
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path

import pytest

from arm_cli.doctor.diagnosis import Severity
from arm_cli.doctor.installation import OWNER_HEADER, check_page_port
from arm_cli.doctor.network import (
    check_discovery,
    check_listening,
    check_ports,
    check_stopped,
    check_users,
)
from arm_viewer.access import Access
from arm_viewer.page_server import page_server
from launch_py.fast_dds.participants import LAST_DOMAIN


@pytest.mark.parametrize(
    ("variables", "severity", "sentence"),
    [
        ({}, Severity.OK, "ROS_DOMAIN_ID 0, range not set"),
        ({"ROS_DOMAIN_ID": "42"}, Severity.OK, "ROS_DOMAIN_ID 42"),
        ({"ROS_DOMAIN_ID": "150"}, Severity.WARNING, "0 to 101 are safe"),
        ({"ROS_DOMAIN_ID": "233"}, Severity.ERROR, "not a number from 0 to 232"),
        ({"ROS_DOMAIN_ID": "mine"}, Severity.ERROR, "'mine'"),
        (
            {"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"},
            Severity.ERROR,
            "programs do not find each other",
        ),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "HERE"}, Severity.ERROR, "the choices are SUBNET"),
        ({"RMW_IMPLEMENTATION": "rmw_zenoh_cpp"}, Severity.ERROR, "rmw_fastrtps_cpp only"),
    ],
)
def test_discovery(variables, severity, sentence):
    finding = check_discovery(variables)
    assert finding.severity is severity
    assert sentence in finding.sentence
    assert bool(finding.fix) is (severity is not Severity.OK)


@pytest.fixture
def taken_domain():
    """Return a domain whose port for announcements another program holds exclusively."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
        for domain in range(LAST_DOMAIN, 101, -1):
            with contextlib.suppress(OSError):
                stranger.bind(("", 7400 + 250 * domain))
                yield str(domain)
                return
        pytest.fail("no domain has a port left")


@pytest.mark.parametrize(
    ("reach", "severity", "sentence"),
    [
        ("", Severity.WARNING, "programs without ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST do not"),
        ("SUBNET", Severity.ERROR, "programs do not find each other"),
        ("LOCALHOST", Severity.OK, "on this machine it is not needed"),
    ],
)
def test_a_port_taken_by_another_program(taken_domain, reach, severity, sentence):
    variables = {"ROS_DOMAIN_ID": taken_domain, "ROS_AUTOMATIC_DISCOVERY_RANGE": reach}
    finding = check_ports(variables)
    assert finding.severity is severity
    assert f"for announcements in domain {taken_domain}, is taken" in finding.sentence
    assert sentence in finding.sentence
    assert ("ss -ulpn" in finding.fix) is (severity is not Severity.OK)


def test_ports_shared_as_by_fast_dds_are_ok():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as participant:
        participant.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        participant.bind(("", 7400 + 250 * LAST_DOMAIN))
        finding = check_ports({"ROS_DOMAIN_ID": str(LAST_DOMAIN)})
    assert finding.severity is Severity.OK, finding
    assert str(7400 + 250 * LAST_DOMAIN) in finding.sentence


def test_an_invalid_domain_has_no_port():
    finding = check_ports({"ROS_DOMAIN_ID": "mine"})
    assert finding.severity is Severity.OK, finding
    assert "127.0.0.1" in finding.sentence


@pytest.mark.parametrize(
    ("addresses", "severity", "sentence"),
    [
        # A documentation address that no machine has, and a reserved address.
        ({"here": "192.0.2.1"}, Severity.ERROR, "datagrams to 192.0.2.1 do not arrive"),
        ({"group": "240.0.0.1"}, Severity.WARNING, "multicast to 240.0.0.1 does not arrive"),
    ],
)
def test_a_network_that_drops_datagrams(addresses, severity, sentence):
    variables = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "ROS_DOMAIN_ID": str(LAST_DOMAIN)}
    finding = check_ports(variables, **addresses)
    assert finding.severity is severity
    assert sentence in finding.sentence
    assert finding.fix


@pytest.fixture
def serve():
    """Return a function that serves a text by HTTP and returns the port."""
    with contextlib.ExitStack() as servers:

        def start(text: str, owner: str = "") -> int:
            class Page(BaseHTTPRequestHandler):
                def do_GET(self) -> None:
                    self.send_response(200)
                    if owner:
                        self.send_header(OWNER_HEADER, owner)
                    self.end_headers()
                    self.wfile.write(text.encode())

                def log_message(self, format: str, *args: object) -> None:
                    pass

            server = servers.enter_context(HTTPServer(("127.0.0.1", 0), Page))
            thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05})
            thread.start()
            servers.callback(thread.join)
            servers.callback(server.shutdown)
            return server.server_port

        yield start


def test_the_page_s_port_is_free_or_used_by_a_page(serve):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    assert check_page_port(port).sentence == f"port {port} is free for the page"
    with page_server(0) as page:
        found = check_page_port(page.get_port())
    assert found.severity is Severity.OK
    assert "a page is running on http://127.0.0.1:" in found.sentence
    assert "other machines" not in found.sentence


def test_a_page_for_other_machines_is_said_to_be_one():
    with page_server(0, access=Access.on("0.0.0.0")) as page:
        found = check_page_port(page.get_port())
    assert found.severity is Severity.OK
    assert found.sentence.endswith("; on 0.0.0.0 it serves other machines, with a token")


@pytest.mark.parametrize(
    ("owner", "whose"),
    [
        (f"{os.getuid()} 7", "that of ROS_DOMAIN_ID=7, not of"),
        (f"{os.getuid() + 1} 42", f"that of user {os.getuid() + 1}, not of"),
        (f"{os.getuid() + 1} 7", f"that of user {os.getuid() + 1} and ROS_DOMAIN_ID=7, not of"),
    ],
)
def test_a_page_of_another_user_or_domain_is_a_warning(serve, monkeypatch, owner, whose):
    monkeypatch.setenv("ROS_DOMAIN_ID", "42")
    finding = check_page_port(serve("<title>Arm suite</title>", owner))
    assert finding.severity is Severity.WARNING
    assert whose in finding.sentence
    assert "viewer_port:=8081" in finding.fix


def test_a_page_port_taken_by_another_program_is_a_warning(serve):
    finding = check_page_port(serve("<title>My notes</title>"))
    assert finding.severity is Severity.WARNING
    assert "is taken by another program" in finding.sentence
    assert "ss -tlpn" in finding.fix


def test_a_page_port_without_http_is_a_warning():
    with socket.socket() as stranger:
        stranger.bind(("127.0.0.1", 0))
        # The socket is bound but does not listen, so connections are refused.
        assert check_page_port(stranger.getsockname()[1]).severity is Severity.WARNING


def _udp_row(address: str, port: int, inode: int) -> str:
    packed = int.from_bytes(socket.inet_aton(address), sys.byteorder)
    return f"1: {packed:08X}:{port:04X} 00000000:0000 07 0:0 0:0 0 0 0 {inode} 2"


@pytest.fixture
def processes(tmp_path):
    """Return a function that adds a process with one UDP socket to a folder like /proc."""
    table: list[str] = []

    def namespace(folder: Path) -> Path:
        (folder / "ns").mkdir(parents=True)
        (folder / "ns/net").symlink_to("net:[1]")
        return folder

    def add(
        pid: int, command: str, address: str, port: int, state: str = "S", **environ: str
    ) -> Path:
        folder = namespace(tmp_path / str(pid))
        table.append(_udp_row(address, port, pid))
        (folder / "fd").mkdir()
        (folder / "fd/3").symlink_to(f"socket:[{pid}]")
        (folder / "net").mkdir()
        (folder / "net/tcp").write_text("header\n")
        (folder / "cmdline").write_text(command.replace(" ", "\0") + "\0")
        (folder / "stat").write_text(f"{pid} (a) b) {state} 1 {pid}")
        (folder / "environ").write_text("".join(f"{k}={v}\0" for k, v in environ.items()))
        for process in tmp_path.glob("[0-9]*"):
            (process / "net/udp").write_text("\n".join(["header", *table, ""]))
        return tmp_path

    namespace(tmp_path / "self")
    return add


def test_listening_addresses_are_listed(processes):
    processes(11, "/venv/bin/python /venv/bin/arm_gazebo_node --ros-args", "127.0.0.1", 7410)
    processes(12, "/opt/ros/talker", "0.0.0.0", 7412, ROS_AUTOMATIC_DISCOVERY_RANGE="SUBNET")
    proc = processes(13, "dnsmasq", "0.0.0.0", 53)
    finding = check_listening({}, proc)
    assert finding.severity is Severity.OK
    assert finding.sentence == ("on 127.0.0.1 only: arm_gazebo_node (11); on 0.0.0.0: talker (12)")
    (other,) = check_listening({"ROS_DOMAIN_ID": "3"}, proc).sentence.splitlines()
    assert other == "no ROS program of yours listens in this domain"


def test_programs_that_are_stopped_are_a_warning(processes):
    processes(11, "python3 -m mine", "127.0.0.1", 7410, state="T")
    assert check_stopped({"ROS_DOMAIN_ID": "3"}, processes(12, "nc", "127.0.0.1", 7412)).fix == ""
    finding = check_stopped({}, processes(13, "/opt/ros/talker", "127.0.0.1", 7414, state="t"))
    assert finding.severity is Severity.WARNING
    assert finding.sentence == (
        "mine (11), talker (13) are stopped and answer nobody until `kill -CONT 11 13`"
    )


def test_a_program_with_localhost_that_listens_everywhere_is_a_warning(processes):
    wish = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    processes(11, "python3 -m mine", "0.0.0.0", 7410, **wish)
    proc = processes(12, "python3 -m peer", "0.0.0.0", 7412, ROS_STATIC_PEERS="192.0.2.7", **wish)
    finding = check_listening({}, proc)
    assert finding.severity is Severity.WARNING
    assert "mine (11): despite ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST" in finding.sentence


def test_other_users_of_the_domain_are_a_warning(tmp_path):
    table = tmp_path / "udp"
    row = _udp_row("127.0.0.1", 7410, 4711).split()
    row[7] = str(os.getuid() + 4_000_000)
    table.write_text(f"header\n{' '.join(row)}\n")
    finding = check_users({}, table)
    assert finding.severity is Severity.WARNING
    assert f"user with id {row[7]} runs ROS programs in this ROS domain" in finding.sentence
    assert "ROS_DOMAIN_ID" in finding.fix
    assert check_users({"ROS_DOMAIN_ID": "3"}, table).severity is Severity.OK
