"""Prevents a second node with the same name on the ROS graph.

Two nodes with the same name answer services and parameters at random: `param set` may reach one of
them and `param get` the other. So the names of the plan are looked up on the graph before anything
is started. Some names are not known then, because a program may name its nodes itself, so the graph
is watched until everything is up.

A lookup takes half a second. The start waits for it only if a process on this host may be a robot.
The kernel's table of UDP ports shows in a millisecond whether this host has any participant.
Bystanders, which only listen, are looked up when everything is up.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from launch_py.fast_dds.participants import (
    PID_BITS,
    ancestors,
    are_bystanders,
    domain_of,
    find_ports,
    own_processes,
    processes_with,
)
from launch_py.plan.steps import ProcessStep, StopDelays
from launch_py.screen.reporter import Reporter
from launch_py.supervision import linux
from launch_py.supervision.event_loop import EventLoop, Timer
from launch_py.supervision.runner import LocalRunner, ProbeClient
from launch_py.system.child_environment import for_program
from launch_py.system.dds_profile import RANGE, STATIC_PEERS


class Replacement:
    """Ends processes of another launch, by SIGINT and then SIGTERM; belongs to the loop's thread.

    It refers to each process by a pidfd, so it cannot hit a later process with the same id. It
    never uses SIGKILL, because a killed process stays on the graph for a while. Those that have
    ended already are skipped. `refuse` is called with an error message if one does not end.
    """

    def __init__(
        self,
        loop: EventLoop,
        pids: Sequence[int],
        refuse: Callable[[str], None],
        delays: StopDelays | None = None,
    ) -> None:
        self._loop = loop
        self._refuse = refuse
        self._delays = delays or StopDelays()
        self._living: dict[int, int] = {}
        for pid in pids:
            self._hold(pid)
        self._signal(signal.SIGINT)
        loop.call_later(self._delays.sigterm_timeout_s, self._terminate)

    @property
    def busy(self) -> bool:
        """Whether one of the processes still runs."""
        return bool(self._living)

    def _hold(self, pid: int) -> None:
        try:
            pidfd = os.pidfd_open(pid)
        except ProcessLookupError:
            return
        self._living[pid] = pidfd
        self._loop.add_reader(pidfd, lambda: self._ended(pid))

    def _signal(self, number: signal.Signals) -> None:
        for pid, pidfd in list(self._living.items()):
            try:
                signal.pidfd_send_signal(pidfd, number)
            except ProcessLookupError:
                self._ended(pid)
            except PermissionError:
                self._give_up(f"this user may not end process {pid}")

    def _terminate(self) -> None:
        if self._living:
            self._signal(signal.SIGTERM)
            self._loop.call_later(self._delays.sigkill_timeout_s, self._too_late)

    def _too_late(self) -> None:
        if self._living:
            pid = next(iter(self._living))
            self._give_up(f"process {pid} does not end after SIGINT and SIGTERM")

    def _give_up(self, why: str) -> None:
        for pid in list(self._living):
            self._ended(pid)
        self._refuse(f"replace:=true: {why}; end it yourself")

    def _ended(self, pid: int) -> None:
        pidfd = self._living.pop(pid, None)
        if pidfd is not None:
            self._loop.remove_reader(pidfd)
            os.close(pidfd)


SETTLE_TIMEOUT_S = 2.0
"""How long the start waits for missing participants after the first list of nodes."""

LOOK_TIMEOUT_S = 15.0
"""How long the start waits for the first list of nodes: a busy machine imports rclpy slowly."""

WATCH_AFTER_START_S = 3.0
"""How long the graph is watched after the start-up: a participant with the default settings of
Fast DDS announces itself every 3 s."""

PAGE = "/arm_viewer"
PAGE_ALONE = "for the page alone, of what runs already: arm view"

Census = Mapping[str, Sequence[int | None]]


class NameGuard:
    """Compares the nodes of one launch with those on the graph; belongs to the loop's thread.

    `replace` ends processes whose nodes have a name of this launch.
    """

    def __init__(
        self,
        loop: EventLoop,
        probes: ProbeClient,
        runner: LocalRunner,
        reporter: Reporter,
        replace: bool,
    ) -> None:
        self._loop = loop
        self._probes = probes
        self._runner = runner
        self._reporter = reporter
        self._replace = replace
        self._refuse: Callable[[str], None] = reporter.problem
        self._wanted: dict[int, frozenset[str]] = {}
        self._looking: dict[int, Timer] = {}
        self._seen: dict[int, Census] = {}
        self._replacement: Replacement | None = None
        self._stop_watching: list[Callable[[], None]] = []
        self._later: list[Callable[[], None]] = []
        self._replaced: set[int | None] = set()

    @property
    def busy(self) -> bool:
        """Whether the start has to wait."""
        return bool(self._looking) or (self._replacement is not None and self._replacement.busy)

    def look(self, steps: Sequence[ProcessStep], refuse: Callable[[str], None]) -> None:
        """Look up the node names of these steps, unless hardly any running node can have one.

        `refuse` is called with an error message if a node must not be started or must be stopped.
        """
        self._refuse = refuse
        for domain, environment in self._domains(steps).items():
            ports = find_ports(domain)
            others_here = bool(ports.indices)
            reach = environment.get(RANGE, "")
            elsewhere = reach != "LOCALHOST" or bool(environment.get(STATIC_PEERS))
            if reach == "OFF" or not (others_here or elsewhere):
                continue
            names = self._names_in(domain, steps)
            # A process to be replaced must be found before the start.
            if others_here and (self._replace or not are_bystanders(ports, names)):
                self._wanted[domain] = names
                self._wait(domain, LOOK_TIMEOUT_S)
                self._watch(domain, environment)
            else:
                # Only bystanders, or processes on other hosts that take long to discover: the
                # start does not wait.
                self._later.append(lambda d=domain, e=environment: self._watch(d, e))

    def settled(self) -> None:
        """Stop watching after a while, because everything is up."""
        for watch in self._later:
            watch()
        self._loop.call_later(WATCH_AFTER_START_S, self.close)

    def close(self) -> None:
        """Stop watching."""
        stop_watching, self._stop_watching = self._stop_watching, []
        for stop in stop_watching:
            stop()
        self._probes.close_idle()

    def _watch(self, domain: int, environment: Mapping[str, str]) -> None:
        self._stop_watching.append(
            self._probes.watch_nodes(
                for_program(sys.executable, environment),
                lambda seen: self._take(domain, seen),
                lambda why: self._cannot_look(domain, why),
            )
        )

    def _wait(self, domain: int, timeout_s: float) -> None:
        """Make the start wait for the nodes of a domain."""
        if domain in self._looking:
            self._looking[domain].cancel()
        timer = self._loop.call_later(timeout_s, lambda: self._stop_waiting(domain))
        self._looking[domain] = timer

    def _stop_waiting(self, domain: int) -> None:
        """Stop waiting and compare the names with the nodes that are known now."""
        if timer := self._looking.pop(domain, None):
            timer.cancel()
            self._look_up(domain, self._seen.get(domain, {}))

    def _domains(self, steps: Iterable[ProcessStep]) -> dict[int, Mapping[str, str]]:
        """Return the domains of the steps, each with the environment of a process there."""
        environments = [self._runner.environment_of(step) for step in steps]
        domains = ((domain_of(e.get("ROS_DOMAIN_ID")), e) for e in environments)
        return {domain: e for domain, e in domains if domain is not None}

    def _names_in(self, domain: int, steps: Iterable[ProcessStep]) -> frozenset[str]:
        """Return the known names of the nodes that the steps start in a domain."""
        return frozenset(
            name
            for step in steps
            if domain_of(self._runner.environment_of(step).get("ROS_DOMAIN_ID")) == domain
            for name in step.node_names()
        )

    def _cannot_look(self, domain: int, why: str) -> None:
        self._stop_waiting(domain)
        self._reporter.detail(f"nodes with the same name are not detected: {why}")

    def _take(self, domain: int, seen: Mapping[str, Any]) -> None:
        census: Census = seen["nodes"]
        if domain not in self._looking:
            self._compare(domain, census)
            return
        first = domain not in self._seen
        self._seen[domain] = census
        if seen["complete"]:
            self._stop_waiting(domain)
        elif first:
            self._wait(domain, SETTLE_TIMEOUT_S)

    def _look_up(self, domain: int, census: Census) -> None:
        """Check before the start that no running node has a name of this launch."""
        taken = {name: census[name] for name in sorted(self._wanted[domain] & census.keys())}
        if not taken:
            return
        if not self._replace:
            page = any(name.endswith(PAGE) for name in self._wanted[domain] - census.keys())
            self._refuse(_names_taken(taken, domain) + f"; {PAGE_ALONE}" * page)
            return
        pids: dict[int, list[str]] = {}
        for name, holders in taken.items():
            for bits in holders:
                found = self._replaceable(bits, domain)
                if len(found) != 1:
                    self._refuse(
                        f"{_name_holders({name: holders}, domain)}: replace:=true ends only "
                        "a process of this user on this host that it can identify; "
                        "end it yourself"
                    )
                    return
                pids.setdefault(found[0], []).append(name)
                self._replaced.add(bits)
        for pid, names in pids.items():
            self._reporter.note(f"ending process {pid}: this launch replaces {_and(names)}")
        self._replacement = Replacement(self._loop, list(pids), self._refuse)

    def _replaceable(self, bits: int | None, domain: int) -> list[int]:
        if bits is None:
            return []
        family = ancestors()
        return [pid for pid in own_processes(bits, find_ports(domain)) if pid not in family]

    def _compare(self, domain: int, census: Census) -> None:
        """Check after the start that no node of this launch shares its name with another."""
        for name, holders in census.items():
            if len(holders) < 2 or name.rpartition("/")[2].startswith("_"):
                continue
            others = [bits for bits in holders if not self._is_ours(bits)]
            ours = [bits for bits in holders if bits not in others]
            living = [
                bits
                for bits in others
                if self._is_alive(bits) and not _is_younger(bits, ours, domain)
            ]
            if living and len(others) < len(holders):
                self._refuse(_names_taken({name: living}, domain))
                return

    def _is_ours(self, bits: int | None) -> bool:
        """Return whether a process of this launch has an id with these bits, or had it."""
        if bits is None:
            return False
        sessions = self._runner.sessions
        if any(session & PID_BITS == bits for session in sessions):
            return True
        return any(linux.session_of(pid) in sessions for pid in processes_with(bits))

    def _is_alive(self, bits: int | None) -> bool:
        """Return whether such a process may be alive. DDS keeps a dead one's names for 20 s."""
        if bits in self._replaced:
            return False
        return bits is None or bool(processes_with(bits))


def _is_younger(other: int | None, ours: Sequence[int | None], domain: int) -> bool:
    """Return whether the other process started after ours: then its own launch has to stop it."""
    if other is None or None in ours or not ours:
        return False
    ports = find_ports(domain)
    started = [
        [linux.start_ticks(pid) for pid in own_processes(bits, ports)]
        for bits in (other, *ours)
        if bits is not None
    ]
    ticks = [times[0] for times in started if len(times) == 1 and times[0] is not None]
    return len(ticks) == 1 + len(ours) and ticks[0] > max(ticks[1:])


def _names_taken(taken: Census, domain: int) -> str:
    """Return the error message for names that are taken."""
    if len(taken) == 1:
        advice = "end it, start this one under another name or in another namespace"
    else:
        advice = "end them, start these under other names or in another namespace"
    return f"{_name_holders(taken, domain)}: {advice}, or take over with replace:=true"


def _name_holders(taken: Census, domain: int) -> str:
    """Return the clause of a message that says which processes have the names."""
    ports = find_ports(domain)
    owners: dict[str, None] = {}
    for bits in dict.fromkeys(bits for holders in taken.values() for bits in holders):
        found = [] if bits is None else own_processes(bits, ports)
        elsewhere = "a process of another host, container or user"
        owners[f"process {found[0]}" if len(found) == 1 else elsewhere] = None
    verb = "is" if len(taken) == 1 else "are"
    return f"{_and(list(taken))} {verb} already on the ROS graph, from {_and(list(owners))}"


def _and(words: Sequence[str]) -> str:
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1])))
