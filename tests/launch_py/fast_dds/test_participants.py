"""DDS participants found in the kernel's tables; the sockets are the test's own."""

import os
import signal
import socket
import subprocess
import sys

import pytest

from launch_py.fast_dds.participants import (
    PID_BITS,
    ancestors,
    domain_of,
    find_ports,
    own_processes,
    processes_with,
)


@pytest.fixture
def first(empty_domain) -> int:
    """Return the first port of a participant in a domain without any."""
    return 7400 + 250 * empty_domain + 10


def bound(port: int) -> socket.socket:
    one = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    # A port beside the domain may be one on which participants of the next listen together.
    one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    one.bind(("127.0.0.1", port))
    return one


def test_participants_are_counted_by_their_ports(first, empty_domain):
    with bound(first), bound(first + 1), bound(first + 4):
        assert find_ports(empty_domain).indices == {0, 2}
    assert not find_ports(empty_domain).indices


@pytest.mark.parametrize("offset", [-11, -10, -1, 240])
def test_a_port_outside_the_domain_is_not_a_participant(first, empty_domain, offset):
    with bound(first + offset):
        assert not find_ports(empty_domain).indices


@pytest.mark.parametrize("port", ["fastrtps_port", "fastdds_port"])
def test_a_locked_port_in_shared_memory_is_a_participant(tmp_path, first, empty_domain, port):
    import fcntl

    for name in (f"{port}{first + 3}_el", f"{port}{first + 7}_el"):
        (tmp_path / name).touch()
    with (tmp_path / f"{port}{first + 3}_el").open() as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        ports = find_ports(empty_domain, str(tmp_path))
    assert ports.indices == {1}
    assert ports.lock_owners == {os.getpid()}
    assert ports.owners == {1: {os.getpid()}}


def test_a_process_counts_only_if_it_listens_on_a_port_of_the_domain(first, empty_domain):
    bits = os.getpid() & PID_BITS
    assert os.getpid() in processes_with(bits)
    with bound(first):
        ports = find_ports(empty_domain)
        assert own_processes(bits, ports) == [os.getpid()]
        code = "import signal; print('up', flush=True); signal.pause()"
        other = subprocess.Popen([sys.executable, "-S", "-c", code], stdout=subprocess.PIPE)
        assert other.stdout is not None
        assert other.stdout.readline() == b"up\n"
        assert own_processes(other.pid & PID_BITS, ports) == []
        other.send_signal(signal.SIGKILL)
        other.communicate()


def test_ancestors_are_this_process_and_those_above_it():
    assert {os.getpid(), os.getppid(), 1} <= ancestors()


@pytest.mark.parametrize(
    ("text", "domain"), [(None, 0), ("", 0), ("7", 7), (" 7 ", 7), ("x", None), ("233", None)]
)
def test_a_domain_is_a_whole_number_up_to_232(text, domain):
    assert domain_of(text) == domain
