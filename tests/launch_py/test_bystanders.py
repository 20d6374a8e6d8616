"""Bystanders, which a launch ignores at its start; the processes and their locks are real."""

import os
import subprocess
import sys

import pytest

from launch_py.fast_dds.participants import are_bystanders, find_ports

READER = """
import fcntl, signal, sys
lock = open(sys.argv[1], "w")
fcntl.flock(lock, fcntl.LOCK_EX)
print("up", flush=True)
signal.pause()
"""


@pytest.fixture
def ports(tmp_path, empty_domain):
    """Return a function that starts a process with a port in shared memory and finds the ports."""
    processes: list[subprocess.Popen[bytes]] = []
    first = 7400 + 250 * empty_domain + 10

    def look(*arguments, index=0, **environment):
        plain = {name: text for name, text in os.environ.items() if name != "NOTIFY_SOCKET"}
        lock = str(tmp_path / f"fastrtps_port{first + 2 * index}_el")
        process = subprocess.Popen(
            [sys.executable, "-S", "-c", READER, lock, *arguments],
            stdout=subprocess.PIPE,
            env={**plain, **environment},
        )
        processes.append(process)
        assert process.stdout is not None
        assert process.stdout.readline() == b"up\n"
        return find_ports(empty_domain, str(tmp_path))

    yield look
    for process in processes:
        process.kill()
        process.wait()
        assert process.stdout is not None
        process.stdout.close()


def test_a_client_of_this_user_is_a_bystander(ports):
    assert are_bystanders(ports(), ["/left/reach_forward"])


def test_a_process_named_like_a_node_of_the_launch_is_not_a_bystander(ports):
    found = ports("run", "reach_forward")
    assert not are_bystanders(found, ["/left/reach_forward"])
    assert are_bystanders(found, ["/left/hold_still"])


def test_a_node_of_a_launch_is_not_a_bystander(ports):
    assert not are_bystanders(ports(NOTIFY_SOCKET="@another"), ["/reach_forward"])


def test_a_node_with_ros_arguments_is_not_a_bystander(ports):
    assert not are_bystanders(ports("--ros-args"), ["/reach_forward"])


def test_one_process_among_several_that_is_not_a_bystander_counts(ports):
    assert are_bystanders(ports(), ["/reach_forward"])
    assert not are_bystanders(ports("reach_forward", index=1), ["/reach_forward"])


def test_a_participant_without_a_lock_is_not_a_bystander(ports):
    found = ports()
    assert are_bystanders(found, ["/reach_forward"])
    unknown = type(found)(found.indices | {7}, found.socket_inodes, found.owners)
    assert not are_bystanders(unknown, ["/reach_forward"])


def test_an_invisible_process_or_one_of_another_user_is_not_a_bystander(ports, monkeypatch):
    found = ports()
    monkeypatch.setattr(os, "geteuid", lambda: os.getuid() + 1)
    assert not are_bystanders(found, ["/reach_forward"])
    monkeypatch.undo()
    hidden = type(found)(found.indices, found.socket_inodes, {0: frozenset({0})})
    assert not are_bystanders(hidden, ["/reach_forward"])
