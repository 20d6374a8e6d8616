"""Conditions whose probe cannot watch them, or ends; without ROS."""

import sys

import pytest

from launch_py.plan.readiness import HttpOk
from launch_py.supervision import linux, runner
from launch_py.supervision.event_loop import EventLoop
from launch_py.supervision.runner import ProbeClient

TIMEOUT_S = 30.0
TOPIC = "actions = [python('a', 'import signal; signal.pause()', ready=TopicPublished('/t'))]"
ANSWERS = """
import json, sys
for line in sys.stdin:
    message = json.loads(line)
    match message.get("url"):
        case "met": print(json.dumps({"id": message["id"]}), flush=True)
        case "never": print(json.dumps({"id": message["id"], "error": "no"}), flush=True)
        case "die": sys.exit(3)
"""


class Trial:
    """A client with fake probes that answer according to the URL."""

    def __init__(self, log_file):
        self.loop = EventLoop()
        self.client = ProbeClient(self.loop, log_file)
        self.told: dict[str, str] = {}
        self.pids: set[int] = set()

    def watch(self, url):
        def tell(what):
            self.told[url] = what

        stop_watching = self.client.watch(HttpOk(url), {}, lambda: tell("met"), tell)
        self.pids |= self.client.pids
        return stop_watching

    def wait(self, *urls):
        """Run the loop until each of these is met or has failed."""
        self.run(until=lambda: self.told.keys() >= set(urls))

    def run(self, until):
        late = self.loop.call_later(TIMEOUT_S, lambda: pytest.fail(f"only {self.told} is known"))
        self.loop.run(until)
        late.cancel()

    def close(self):
        """End the probes and reap them."""

        def none_is_left():
            self.client.reap()
            self.loop.call_later(0.01, lambda: None)
            return not self.pids & set(linux.children())

        self.client.close()
        self.run(until=none_is_left)
        self.loop.close()


@pytest.fixture
def trial(tmp_path, monkeypatch):
    monkeypatch.setattr(runner, "PROBE_COMMAND", (sys.executable, "-S", "-c", ANSWERS))
    trial = Trial(tmp_path / "probe.log")
    yield trial
    trial.close()


def test_a_condition_that_can_never_be_met_fails(trial):
    trial.watch("never")
    trial.watch("met")
    trial.wait("never", "met")
    assert trial.told == {"never": "no", "met": "met"}


def test_a_probe_that_ends_fails_all_its_conditions(trial, tmp_path):
    trial.watch("open")
    trial.watch("forgotten")()
    trial.watch("die")
    trial.wait("open", "die")
    text = f"the probe that watches for it has ended; see {tmp_path / 'probe.log'}"
    assert trial.told == {"open": text, "die": text}
    trial.watch("met")
    trial.wait("met")


def test_a_probe_with_something_to_watch_is_not_idle(trial):
    stop_watching = trial.watch("open")
    trial.client.close_idle()
    trial.watch("met")
    trial.wait("met")
    assert len(trial.client.pids) == 1
    stop_watching()


def test_a_closing_probe_gets_no_more_conditions(trial):
    trial.watch("met")
    trial.wait("met")
    trial.client.close_idle()
    trial.told.clear()
    trial.watch("met")
    trial.wait("met")
    assert trial.told == {"met": "met"}


@pytest.mark.parametrize(
    ("rclpy", "reason"),
    [
        ("raise ImportError('not here')", "cannot watch a TopicPublished condition: not here"),
        ("import os; os._exit(3)", "the probe that watches for it has ended; see .*/probe.log"),
    ],
)
def test_a_launch_that_could_never_be_ready_ends_at_once(launch, tmp_path, rclpy, reason):
    (tmp_path / "rclpy.py").write_text(rclpy)
    launched = launch(TOPIC, PYTHONPATH=str(tmp_path))
    assert launched.wait() == 1
    launched.wait_for(f"exit code 1: a cannot become ready: {reason}$")
