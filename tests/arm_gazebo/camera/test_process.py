"""Supervision of the camera process, with a fake process."""

import os
import signal
import subprocess

import pytest

from arm_gazebo.camera.process import EXIT_BACKEND, CameraProcess, CameraSettings
from arm_gazebo.sensors.camera import CameraSensor


class FakeChild:
    def __init__(self, command: list[str], **options) -> None:
        self.command = command
        self.options = options
        self.returncode: int | None = None
        self.pid = 4321
        self.insisted: list[str] = []
        self.ends_on = "wait"

    @property
    def settings(self) -> CameraSettings:
        return CameraSettings.from_json(self.command[self.command.index("--settings") + 1])

    def poll(self) -> int | None:
        return self.returncode

    def wait(self, timeout: float | None) -> int:
        if self.ends_on not in ["wait", *self.insisted] and timeout is not None:
            raise subprocess.TimeoutExpired(self.command, timeout)
        return 0

    def terminate(self) -> None:
        self.insisted.append("terminate")

    def kill(self) -> None:
        self.insisted.append("kill")


class World:
    """A camera process with its clock and its children."""

    def __init__(self, *ros_arguments: str) -> None:
        self.now_s = 100.0
        self.children: list[FakeChild] = []
        self.process = CameraProcess(
            CameraSettings((CameraSensor("c", "l", "f"),)),
            ros_arguments,
            environ={"NOTIFY_SOCKET": "/run/x", "HOME": "/home/me"},
            clock=lambda: self.now_s,
            spawn=self.spawn,
        )
        self.process.start(7)

    def spawn(self, command: list[str], **options) -> FakeChild:
        self.children.append(FakeChild(command, **options))
        return self.children[-1]

    def die(self, code: int, *backends: str, after_s: float = 0.0) -> bool:
        """Let the child die; return whether it should be restarted at once."""
        self.now_s += after_s
        self.children[-1].returncode = code
        return self.process.start_again_due(backends)


@pytest.fixture
def world():
    return World()


def test_the_child_inherits_the_socket_and_gets_its_parents_id(world):
    (child,) = world.children
    assert child.options["pass_fds"] == (7,)
    assert child.command[child.command.index("--socket") + 1] == "7"
    assert child.command[child.command.index("--parent") + 1] == str(os.getpid())
    assert "--ros-args" not in child.command


def test_the_child_does_not_inherit_the_notify_socket(world):
    environment = world.children[0].options["env"]
    assert "NOTIFY_SOCKET" not in environment
    assert environment["HOME"] == "/home/me"


def test_ros_arguments_are_handed_on():
    (child,) = World("-r", "__ns:=/lab").children
    assert child.command[-3:] == ["--ros-args", "-r", "__ns:=/lab"]


def test_a_living_child_is_left_alone(world):
    assert not world.process.start_again_due(["egl"])


def test_a_child_that_died_starts_again_after_a_growing_delay(world):
    delays = []
    for _ in range(7):
        assert not world.die(1)
        began_s = world.now_s
        while not world.process.start_again_due([]):
            world.now_s += 0.5
        delays.append(world.now_s - began_s)
        world.process.start(7)
    assert delays == [1, 2, 4, 8, 16, 30, 30]


def test_what_cannot_be_started_is_tried_again(caplog):
    def no_memory(*_arguments: object, **_options: object) -> None:
        raise OSError("Cannot allocate memory")

    now_s = 0.0
    settings = CameraSettings((CameraSensor("c", "l", "f"),))
    process = CameraProcess(settings, environ={}, clock=lambda: now_s, spawn=no_memory)
    process.start(7)
    assert "cannot be started (Cannot allocate memory)" in caplog.text
    assert not process.start_again_due([])
    now_s = 1.0
    assert process.start_again_due([])


def test_what_was_never_started_is_not_started_again():
    process = CameraProcess(CameraSettings(()), environ={})
    assert not process.start_again_due([])


def test_a_long_run_resets_the_restart_delay(world):
    world.die(1)
    world.now_s += 1.0
    world.process.start(7)
    assert not world.die(1, after_s=1000.0)
    world.now_s += 1.0
    assert world.process.start_again_due([])


@pytest.mark.parametrize("code", [-signal.SIGSEGV, -signal.SIGABRT, EXIT_BACKEND])
def test_a_backend_that_crashes_the_child_is_excluded_at_once(world, code, caplog):
    assert world.die(code, "egl")
    world.process.start(7)
    assert world.children[-1].settings.excluded == ("egl",)
    assert "without egl" in caplog.text
    assert world.die(code, "osmesa")
    world.process.start(7)
    assert world.children[-1].settings.excluded == ("egl", "osmesa")


def test_a_backend_announced_before_the_crash_is_excluded(world):
    assert not world.process.start_again_due(["egl"])
    assert world.die(-signal.SIGSEGV)
    assert world.process.settings.excluded == ("egl",)


@pytest.mark.parametrize(
    ("code", "backends"),
    [
        (-signal.SIGKILL, ["egl"]),
        (-signal.SIGTERM, ["egl"]),
        (0, ["egl"]),
        (1, ["egl"]),
        (-signal.SIGSEGV, []),
        (-signal.SIGSEGV, ["egl", "raycast"]),
    ],
)
def test_other_deaths_say_nothing_about_the_backend(world, code, backends):
    assert not world.die(code, *backends)
    assert world.process.settings.excluded == ()


@pytest.mark.parametrize(
    ("ends_on", "insisted"),
    [("wait", []), ("terminate", ["terminate"]), ("kill", ["terminate", "kill"])],
)
def test_the_end_insists_as_far_as_needed(world, ends_on, insisted):
    (child,) = world.children
    child.ends_on = ends_on
    world.process.end()
    assert child.insisted == insisted
    world.process.end()
    assert child.insisted == insisted
