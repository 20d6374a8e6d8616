"""Selection of the render backend."""

import logging

import pytest

from arm_gazebo.errors import BackendError, CameraError
from arm_gazebo.rendering import backend_selection as module
from arm_gazebo.rendering.backend_selection import backend_order, open_renderer


class Context:
    """Pretends to be an OpenGL context."""

    name = "egl"

    def make_current(self) -> None:
        pass

    def free(self) -> None:
        pass


def missing() -> Context:
    raise CameraError("libEGL.so.1 is not installed")


def test_automatic_prefers_opengl_and_ends_with_rays():
    assert backend_order("auto") == ("egl", "osmesa", "raycast")


def test_what_failed_before_is_left_out_but_rays_never():
    assert backend_order("auto", ["egl", "raycast"]) == ("osmesa", "raycast")


def test_a_named_backend_is_tried_before_rays():
    assert backend_order("osmesa") == ("osmesa", "raycast")
    assert backend_order("raycast") == ("raycast",)
    assert backend_order("egl", ["egl"]) == ("raycast",)


def test_an_unknown_backend_is_refused_naming_the_known_ones():
    with pytest.raises(CameraError, match="'vulkan'; there are auto, egl, osmesa, raycast"):
        backend_order("vulkan")


def test_without_opengl_one_warning_names_the_packages(monkeypatch, caplog):
    monkeypatch.setattr(module, "CONTEXTS", {"egl": missing, "osmesa": missing})
    tried: list[str] = []
    with caplog.at_level(logging.WARNING):
        renderer = open_renderer(["egl", "osmesa", "raycast"], 64, 48, tried.append)
    assert renderer.backend == "raycast"
    assert tried == ["egl", "osmesa", "raycast"]
    (record,) = caplog.records
    assert "apt install libegl1 libgl1-mesa-dri" in record.message
    assert "libEGL.so.1 is not installed" in record.message


def test_rays_by_choice_give_no_warning(caplog):
    assert open_renderer(["raycast"], 64, 48).backend == "raycast"
    assert caplog.records == []


def test_a_backend_that_draws_nothing_fails_the_self_test(monkeypatch):
    class Blind:
        backend = "egl"

        def __init__(self, *_arguments: object) -> None:
            pass

        def set_model(self, _model: object) -> None:
            pass

        def render(self, *_arguments: object) -> None:
            pass

    monkeypatch.setattr(module, "CONTEXTS", {"egl": Context})
    monkeypatch.setattr(module, "GlRenderer", Blind)
    with pytest.raises(BackendError, match="egl draws an empty image"):
        open_renderer(["egl", "raycast"], 64, 48)
