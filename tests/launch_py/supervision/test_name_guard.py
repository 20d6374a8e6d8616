"""Nodes that prevent a launch from starting; the census is fake, the processes are real."""

import os
import signal
import socket
import subprocess
import sys
from dataclasses import dataclass, field

import pytest

from launch_py.fast_dds.participants import PID_BITS
from launch_py.plan.steps import ProcessStep
from launch_py.screen.log_folder import LogFolder
from launch_py.screen.reporter import Reporter
from launch_py.supervision import name_guard
from launch_py.supervision.event_loop import EventLoop
from launch_py.supervision.name_guard import LOOK_TIMEOUT_S, SETTLE_TIMEOUT_S, NameGuard
from launch_py.testing import FakeClock, RecordingScreen

PARTICIPANT = """
import signal, socket, sys
reader = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
reader.bind(("127.0.0.1", int(sys.argv[1])))
print("up", flush=True)
signal.pause()
"""
NO_PROCESS = 0x10000 - 7
"""The low bits of an id that no process has."""


@dataclass
class FakeProbes:
    """Records the requests; the test answers them."""

    seen: list = field(default_factory=list)
    failed: list = field(default_factory=list)
    stopped: int = 0

    def watch_nodes(self, environment, on_seen, on_failed):
        self.seen.append(on_seen)
        self.failed.append(on_failed)

        def stop():
            self.stopped += 1

        return stop

    def close_idle(self):
        pass


@dataclass
class FakeRunner:
    environment: dict
    sessions: set = field(default_factory=set)

    def environment_of(self, step):
        return self.environment


class Trial:
    def __init__(self, logs, replace, environment):
        self.clock = FakeClock()
        self.loop = EventLoop(self.clock)
        self.probes = FakeProbes()
        self.runner = FakeRunner(environment)
        self.screen = RecordingScreen()
        self.refusals: list[str] = []
        reporter = Reporter(self.screen, logs)
        self.guard = NameGuard(self.loop, self.probes, self.runner, reporter, replace)

    def look(self, *names):
        step = ProcessStep(name="process", command=("true",), node_names=lambda: names)
        self.guard.look([step], self.refusals.append)

    def tell(self, complete=True, **nodes):
        census = {f"/{name}": holders for name, holders in nodes.items()}
        self.probes.seen[0]({"nodes": census, "complete": complete})

    def advance(self, seconds):
        self.clock.advance(seconds)
        self.loop.call_due_timers()


@pytest.fixture
def trial(tmp_path, empty_domain):
    logs = LogFolder(tmp_path)
    here = {"ROS_DOMAIN_ID": str(empty_domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    trials: list[Trial] = []

    def begin(replace=False, **environment):
        trials.append(Trial(logs, replace, {**here, **environment}))
        return trials[-1]

    yield begin
    for one in trials:
        one.loop.close()
    logs.close()


@pytest.fixture
def port(empty_domain) -> int:
    """The first port of a participant in the domain."""
    return 7400 + 250 * empty_domain + 10


@pytest.fixture
def participant(port):
    """A process of this user that listens on a port of the domain."""
    command = [sys.executable, "-S", "-c", PARTICIPANT, str(port)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE)
    assert process.stdout is not None
    assert process.stdout.readline() == b"up\n"
    yield process
    process.kill()
    process.wait()
    process.stdout.close()


@pytest.fixture
def somebody(port):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as reader:
        reader.bind(("127.0.0.1", port))
        yield


def test_without_other_participants_the_start_does_not_wait_or_probe(trial):
    one = trial()
    one.look("/arm")
    assert not one.guard.busy
    assert not one.probes.seen
    one.guard.settled()
    assert not one.probes.seen


def test_a_name_on_the_graph_is_refused_with_its_process(trial, participant):
    one = trial()
    one.look("/arm", "/other")
    assert one.guard.busy
    one.tell(arm=[participant.pid & PID_BITS], somebody=[None])
    assert not one.guard.busy
    assert one.refusals == [
        f"/arm is already on the ROS graph, from process {participant.pid}: end it, start this one "
        "under another name or in another namespace, or take over with replace:=true"
    ]


def test_a_launch_with_a_page_names_what_opens_the_page_alone(trial, participant):
    one = trial()
    one.look("/arm", "/arm_viewer")
    one.tell(arm=[participant.pid & PID_BITS])
    assert one.refusals[0].endswith("; for the page alone, of what runs already: arm view")


def test_all_taken_names_are_in_one_sentence(trial, participant):
    one = trial()
    one.look("/b", "/a")
    one.tell(a=[participant.pid & PID_BITS], b=[participant.pid & PID_BITS])
    (refusal,) = one.refusals
    assert refusal.startswith(
        f"/a and /b are already on the ROS graph, from process {participant.pid}"
    )


def test_a_census_without_the_names_allows_the_start(trial, somebody):
    one = trial()
    one.look("/arm")
    one.tell(complete=False, other=[None])
    assert one.guard.busy
    one.tell(other=[None], another=[None])
    assert not one.guard.busy
    assert not one.refusals


def test_a_census_that_never_completes_is_used_as_it_is(trial, somebody):
    one = trial()
    one.look("/arm")
    one.tell(complete=False, arm=[None])
    one.advance(SETTLE_TIMEOUT_S)
    assert not one.guard.busy
    assert "from a process of another host, container or user" in one.refusals[0]


def test_a_silent_or_failed_probe_does_not_block_the_start_forever(trial, somebody):
    one = trial()
    one.look("/arm")
    one.advance(LOOK_TIMEOUT_S)
    assert not one.guard.busy
    another = trial()
    another.look("/arm")
    another.probes.failed[0]("it has ended")
    assert not another.guard.busy
    assert not one.refusals + another.refusals


def test_replace_ends_the_process_and_then_starts(trial, participant):
    one = trial(replace=True)
    one.look("/arm")
    one.tell(arm=[participant.pid & PID_BITS])
    assert one.guard.busy
    assert one.screen.lines == [f"ending process {participant.pid}: this launch replaces /arm"]
    one.loop.run(until=lambda: not one.guard.busy)
    assert participant.wait() == -signal.SIGINT
    one.runner.sessions.add(participant.pid + 1)
    one.tell(arm=[participant.pid & PID_BITS, (participant.pid + 1) & PID_BITS])
    assert not one.refusals


@pytest.mark.parametrize("holders", [[None], [NO_PROCESS]])
def test_replace_does_not_end_a_process_that_it_cannot_identify(trial, somebody, holders):
    one = trial(replace=True)
    one.look("/arm")
    one.tell(arm=holders)
    assert not one.guard.busy
    assert "replace:=true ends only a process of this user on this host" in one.refusals[0]


def test_replace_ends_neither_the_launcher_nor_its_ancestors(trial, somebody):
    one = trial(replace=True)
    one.look("/arm")
    one.tell(arm=[os.getpid() & PID_BITS])
    assert "end it yourself" in one.refusals[0]


def test_a_node_that_takes_another_node_s_name_is_refused_once_it_appears(trial, participant):
    one = trial()
    one.look()
    one.tell(arm=[participant.pid & PID_BITS])
    own = 4242
    one.runner.sessions.add(own)
    one.tell(arm=[participant.pid & PID_BITS, own], arm2=[own], _hidden=[own, participant.pid])
    (refusal,) = one.refusals
    assert refusal.startswith(f"/arm is already on the ROS graph, from process {participant.pid}")


def test_a_restart_is_not_refused_because_of_the_crashed_run(trial, somebody):
    one = trial()
    one.look("/arm")
    one.tell()
    one.runner.sessions |= {4242, 4243}
    one.tell(arm=[4242])
    one.tell(arm=[4242, 4243])
    # Nor because of the crashed process's child, which led no session of its own.
    one.tell(arm=[4243, NO_PROCESS])
    assert not one.refusals


def test_duplicate_nodes_of_other_launches_are_ignored(trial, participant):
    one = trial()
    one.look("/mine")
    one.tell(arm=[participant.pid & PID_BITS, None])
    one.tell(arm=[participant.pid & PID_BITS, None], more=[None])
    assert not one.refusals


@pytest.mark.parametrize("replace", [False, True])
def test_bystanders_are_checked_after_the_start(trial, somebody, monkeypatch, replace):
    monkeypatch.setattr(name_guard, "are_bystanders", lambda ports, names: True)
    one = trial(replace)
    one.look("/arm")
    # A process to be replaced must be known before the start.
    assert one.guard.busy is replace
    assert bool(one.probes.seen) is replace
    if replace:
        return
    one.guard.settled()
    one.runner.sessions.add(4242)
    one.tell(arm=[4242, None])
    assert "/arm is already on the ROS graph" in one.refusals[0]


def test_other_hosts_are_checked_after_the_start(trial):
    one = trial(ROS_AUTOMATIC_DISCOVERY_RANGE="SUBNET")
    one.look("/arm")
    assert not one.guard.busy
    assert not one.probes.seen
    one.guard.settled()
    one.runner.sessions.add(4242)
    one.tell(arm=[4242, None])
    assert "a process of another host" in one.refusals[0]
    one.advance(60.0)
    assert one.probes.stopped == 1
