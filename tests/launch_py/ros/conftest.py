"""Lets rcl itself judge parameters: nodes read what launch files pass to them."""

import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from launch_py.plan.steps import GeneratedFile, LaunchPlan

READ = """
import json, sys
import rclpy
from rclpy.node import Node

context = rclpy.Context()
rclpy.init(context=context)
for line in sys.stdin:
    name, namespace, arguments = json.loads(line)
    node = Node(
        name, namespace=namespace, context=context, use_global_arguments=False,
        enable_rosout=False, start_parameter_services=False, cli_args=["--ros-args", *arguments],
    )
    values = {name: p.value for name, p in node._parameter_overrides.items()}
    plain = {n: list(v) if hasattr(v, "typecode") else v for n, v in values.items()}
    print("VALUES", json.dumps(plain), flush=True)
    node.destroy_node()
rclpy.shutdown(context=context)
"""


@pytest.fixture(scope="session")
def read_by_nodes() -> Iterator[Callable[..., list[dict[str, Any]]]]:
    """Return the parameters of nodes that start with these ROS arguments."""
    with subprocess.Popen(
        [sys.executable, "-c", READ], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        given, printed = process.stdin, process.stdout

        def read(
            arguments: list[list[str]], name: str = "n", namespace: str = "/"
        ) -> list[dict[str, Any]]:
            values: list[dict[str, Any]] = []
            for each in arguments:
                given.write(f"{json.dumps((name, namespace, each))}\n")
                given.flush()
                # Fast DDS may print errors first, about shared memory of killed programs.
                line = next(line for line in printed if line.startswith("VALUES "))
                values.append(json.loads(line.removeprefix("VALUES ")))
            return values

        yield read
        given.close()


@pytest.fixture(scope="session")
def ros_arguments() -> Callable[[LaunchPlan, Path], list[str]]:
    """Return the ROS arguments of the only process of a plan, with its files in a folder."""

    def arguments(plan: LaunchPlan, folder: Path) -> list[str]:
        [process] = plan.processes
        folder.mkdir(exist_ok=True)
        words: list[str] = []
        for word in process.command[process.command.index("--ros-args") + 1 :]:
            if isinstance(word, GeneratedFile):
                path = folder / f"{len(words)}{word.suffix}"
                path.write_text(word.text, encoding="utf-8")
                word = str(path)
            words.append(word)
        return words

    return arguments
