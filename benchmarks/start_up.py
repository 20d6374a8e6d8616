"""Time from `arm launch` to the first joint state and image; a late client's wait; memory."""

import argparse
import statistics
import time

import harness


def start_once(topic: str, *arguments: str) -> float:
    """Return the time from the launcher's start to the topic's first message, in seconds."""
    with harness.fresh_domain():
        client = harness.Client("first", "--topic", topic)
        client.answer()
        running = harness.Suite(*arguments)
        try:
            first_s = client.answer()["first_s"]
            running.wait_until_ready()
        finally:
            running.stop()
            client.stop()
        return first_s - running.started_s


def late_clients(runs: int) -> list[float]:
    """Return for each client the time from its node to its first joint state, in seconds."""
    waits = []
    with harness.suite("camera:=none"):
        for _ in range(runs):
            client = harness.Client("first")
            made_s = client.answer()["node_made_s"]
            waits.append(client.answer()["first_s"] - made_s)
            client.stop()
    return waits


def memory_mb(*arguments: str) -> float:
    """Return the memory of a launch and all that it started, in MB."""
    with harness.started(*arguments) as running:
        time.sleep(harness.SETTLED_S)
        return running.memory_mb()


def spread(values: list[float]) -> str:
    """Return median and maximum as text."""
    return f"median {statistics.median(values):.2f} s, max {max(values):.2f} s (n={len(values)})"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=20)
    runs = parser.parse_args().runs
    states = [start_once("/joint_states") for _ in range(runs)]
    images = [start_once("/videocamera") for _ in range(max(3, runs // 2))]
    harness.print_table(
        "Start",
        [
            harness.Row(
                "`arm launch` to first /joint_states, waiting default subscriber",
                spread(states),
                "median 1.5 s, max 3 s",
            ),
            harness.Row("`arm launch` to first image", spread(images), "3.5 s"),
            harness.Row(
                "late default client: node to first /joint_states",
                spread(late_clients(runs)),
                "median 0.6 s, max 1.2 s",
            ),
            harness.Row(
                "memory (Pss) of all that `arm launch` starts, with its camera and without",
                f"{memory_mb():.0f} MB, {memory_mb('camera:=none'):.0f} MB",
                "184 MB without",
            ),
        ],
    )


if __name__ == "__main__":
    main()
