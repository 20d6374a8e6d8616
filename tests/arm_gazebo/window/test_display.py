"""Whether a window can open is checked before anything starts."""

import socket
from collections.abc import Iterator

import pytest

from arm_gazebo.errors import WindowError
from arm_gazebo.window.display import check_display


@pytest.fixture
def served(tmp_path, monkeypatch) -> Iterator[str]:
    """A display whose server listens, the only one there is."""
    prefix = tmp_path / "X"
    monkeypatch.setattr("arm_gazebo.window.display.X11_SOCKET", str(prefix))
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as server:
        server.bind(f"{prefix}7")
        server.listen()
        yield ":7"


def refusal(environ: dict[str, str]) -> str:
    with pytest.raises(WindowError) as raised:
        check_display(environ)
    return str(raised.value)


@pytest.mark.parametrize("environ", [{}, {"DISPLAY": ""}, {"WAYLAND_DISPLAY": ""}])
def test_a_missing_display_is_refused_with_advice(environ):
    said = refusal(environ)
    assert "DISPLAY is not set" in said
    assert "Xvfb" in said


@pytest.mark.parametrize("display", [":8", "unix:8", ":8.0"])
def test_a_display_without_a_server_is_refused(served, display):
    assert f"no X server answers on DISPLAY={display}" in refusal({"DISPLAY": display})


@pytest.mark.parametrize("suffix", ["", ".0"])
def test_a_display_that_answers_is_fine(served, suffix):
    assert check_display({"DISPLAY": served + suffix}) is None


@pytest.mark.parametrize("environ", [{"WAYLAND_DISPLAY": "wayland-0"}, {"DISPLAY": "desk:10.0"}])
def test_other_displays_are_left_to_the_window(served, environ):
    assert check_display(environ) is None
