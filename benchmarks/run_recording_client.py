"""Lets a simulation record by turns; prints what its ticks cost as JSON.

python run_recording_client.py FOLDER TURNS
"""

import json
import sys
from pathlib import Path
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.srv import SetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.utilities import try_shutdown

SKIPPED, KEPT = 2, 3
"""Reports of a second each: the first ones of a turn cover its beginning."""
TIMEOUT_S = 30.0


class RecordingNode(Node):
    """Sets `record_run`, and hears what ticks cost."""

    def __init__(self) -> None:
        super().__init__("run_recording_client")
        self._setter = self.create_client(SetParameters, "/arm_gazebo/set_parameters")
        self._setter.wait_for_service(TIMEOUT_S)
        self._costs_us: list[float] = []
        self.create_subscription(DiagnosticArray, "/simulation/statistics", self._note, 10)

    def record(self, path: str) -> None:
        """Begin a recording, or end it with "", as soon as the simulation answers."""
        wish = Parameter("record_run", value=path).to_parameter_msg()
        future = self._setter.call_async(SetParameters.Request(parameters=[wish]))
        rclpy.spin_until_future_complete(self, future, timeout_sec=TIMEOUT_S)
        answer = future.result()
        assert answer is not None, "no answer"
        assert answer.results[0].successful, answer.results[0].reason

    def turn(self) -> list[float]:
        """Return what a tick costs in some seconds in a row, in us."""
        self._costs_us.clear()
        while len(self._costs_us) < SKIPPED + KEPT:
            rclpy.spin_once(self, timeout_sec=TIMEOUT_S)
        return self._costs_us[SKIPPED:]

    def _note(self, message: Any) -> None:
        (tick,) = (status for status in message.status if status.name == "tick")
        (whole,) = (item.value for item in tick.values if item.key == "whole (us)")
        self._costs_us.append(float(whole))


def main() -> None:
    """Take turns, and print what was seen."""
    folder, turns = Path(sys.argv[1]), int(sys.argv[2])
    rclpy.init()
    node = RecordingNode()
    seen: dict[str, list[list[float]]] = {"plain": [], "recorded": []}
    for number in range(turns):
        seen["plain"].append(node.turn())
        node.record(str(folder / f"{number}.run"))
        seen["recorded"].append(node.turn())
        node.record("")
    print(json.dumps(seen), flush=True)
    try_shutdown()


if __name__ == "__main__":
    main()
