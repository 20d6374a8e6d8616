"""The example package, from its sources."""

import os
import threading
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2] / "examples"


@pytest.fixture(autouse=True)
def _importable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "servo_arm"))


@pytest.fixture
def servo_info() -> Callable[..., Any]:
    """Make the hardware description of two servos on a port."""
    from arm_control import parse_hardware_info
    from arm_description import expand_xacro

    model = ROOT / "servo_arm" / "urdf" / "servo_arm.urdf.xacro"

    def make(port: Path, timeout_s: float = 5.0) -> Any:
        urdf = expand_xacro(model, {"device": str(port), "timeout": str(timeout_s)})
        (info,) = parse_hardware_info(urdf)
        return info

    return make


@pytest.fixture
def port(tmp_path: Path) -> Iterator[Path]:
    """Return the port of two fake servos that answer until the test ends."""
    from servo_arm.fake_servo import pseudo_terminal, serve

    link = tmp_path / "port"
    with pseudo_terminal(link) as near:
        # The thread ends when nobody has the other end open any more. Its descriptor is its own: it
        # must not read from another terminal that gets the number of a closed one.
        own = os.dup(near)
        threading.Thread(target=serve_until_closed, args=(serve, own), daemon=True).start()
        yield link


def serve_until_closed(serve: Callable[[int, int], None], near: int) -> None:
    with suppress(OSError):
        serve(near, 2)
    os.close(near)
