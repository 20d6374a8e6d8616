"""Frames: poses, lookups through the tree, and the tree as text."""

import math

import pytest

from arm_cli.errors import NoSuchNameError
from arm_cli.tf.frame_log import FrameLog
from arm_cli.tf.showing import describe_delays, describe_lookup, export, frame_graph
from arm_node.rigid_transform import RigidTransform

HALF = math.sqrt(0.5)
QUARTER_TURN = (0.0, 0.0, HALF, HALF)
"""Of 90 degrees about z."""


@pytest.fixture
def log():
    log = FrameLog()
    log.add("world", "base", 0.0, RigidTransform((0.0, 0.0, 1.0)), static=True)
    for stamp_s in (1.0, 1.1, 1.2):
        log.add("base", "arm", stamp_s, RigidTransform((1.0, 0.0, 0.0), QUARTER_TURN), static=False)
    log.add("arm", "hand", 0.0, RigidTransform((0.5, 0.0, 0.0)), static=True)
    log.add("base", "camera", 0.0, RigidTransform((0.0, 2.0, 0.0)), static=True)
    return log


def test_a_lookup_goes_down_the_tree(log):
    lookup = log.lookup("world", "hand")
    assert lookup.pose.position == pytest.approx((1.0, 0.5, 1.0))
    assert lookup.stamp_s == 1.2


def test_a_lookup_goes_up_and_across(log):
    assert log.lookup("hand", "world").pose.position == pytest.approx((-0.5, 1.0, -1.0))
    across = log.lookup("camera", "hand")
    assert across.pose.position == pytest.approx((1.0, -1.5, 0.0))
    assert log.lookup("world", "camera").stamp_s == 0.0


def test_a_lookup_that_fails_is_explained(log):
    with pytest.raises(NoSuchNameError, match="no frame 'hnd'; did you mean 'hand'"):
        log.lookup("world", "hnd")
    log.add("moon", "rock", 0.0, RigidTransform(), static=True)
    with pytest.raises(NoSuchNameError, match="their roots are 'world' and 'moon'"):
        log.lookup("hand", "rock")


def test_frames_in_a_loop_do_not_hang_the_lookup(log):
    log.add("b", "a", 0.0, RigidTransform(), static=True)
    log.add("a", "b", 0.0, RigidTransform(), static=True)
    assert log.lookup("a", "b").pose.position == (0.0, 0.0, 0.0)
    assert "world" in list(log.draw_tree())


def test_the_tree_as_text(log):
    assert list(log.draw_tree()) == [
        "world",
        "└── base  (static)",
        "    ├── arm  (10.0 Hz)",
        "    │   └── hand  (static)",
        "    └── camera  (static)",
    ]


def test_a_lookup_as_text(log):
    assert describe_lookup(log.lookup("base", "arm")).splitlines() == [
        "At time 1.200000000",
        "- Translation: [1.000, 0.000, 0.000]",
        "- Rotation: in Quaternion (xyzw) [0.000, 0.000, 0.707, 0.707]",
        "- Rotation: in RPY (radian) [0.000, 0.000, 1.571]",
        "- Rotation: in RPY (degree) [0.000, 0.000, 90.000]",
        "- Matrix:",
        "  0.000 -1.000  0.000  1.000",
        "  1.000  0.000  0.000  0.000",
        "  0.000  0.000  1.000  0.000",
        "  0.000  0.000  0.000  1.000",
    ]


def test_the_tree_as_a_graph(log):
    graph = frame_graph(log)
    assert [vertex.key for vertex in graph.vertices] == ["arm", "base", "camera", "hand", "world"]
    (edge,) = (edge for edge in graph.edges if edge.target == "arm")
    assert edge.source == "base"
    assert "Average rate: 10.000\nBuffer length: 0.200" in edge.label


def put_dot(folder, monkeypatch, script):
    """Put a script on PATH as graphviz' `dot`."""
    (folder / "dot").write_text(f"#!/bin/sh\n{script}\n")
    (folder / "dot").chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}:/usr/bin:/bin")


def test_with_graphviz_the_tree_becomes_a_pdf(log, tmp_path, monkeypatch):
    draw = '[ "$1 $3" = "-Tpdf -o" ] && grep -q \'"base" -> "arm"\' "$2" && echo %PDF-1.7 > "$4"'
    put_dot(tmp_path, monkeypatch, draw)
    assert export(log, tmp_path / "frames_1.2") == f"Exported graph to {tmp_path}/frames_1.2.pdf"
    assert (tmp_path / "frames_1.2.pdf").read_bytes().startswith(b"%PDF")


def test_without_graphviz_the_tree_is_svg_and_the_message_tells_how_to_get_a_pdf(
    log, tmp_path, monkeypatch
):
    monkeypatch.setenv("PATH", str(tmp_path))
    said = export(log, tmp_path / "frames")
    assert said.startswith(f"Exported graph to {tmp_path}/frames.svg; no PDF, because graphviz is")
    assert said.endswith("not installed: apt install graphviz")
    assert "base" in (tmp_path / "frames.svg").read_text()


def test_a_graphviz_failure_is_reported(log, tmp_path, monkeypatch):
    put_dot(tmp_path, monkeypatch, "exit 1")
    assert (
        f"frames.svg; no PDF, because graphviz' dot failed: dot -Tpdf {tmp_path}/frames.gv"
        in export(log, tmp_path / "frames")
    )


def test_a_frame_whose_time_went_back_has_the_rate_of_the_new_time(log):
    for stamp_s in (0.0, 0.05, 0.1):
        log.add("base", "arm", stamp_s, RigidTransform(), static=False)
    assert log.frames["arm"].rate_hz == pytest.approx(20.0)
    assert log.lookup("base", "arm").stamp_s == 0.1


def test_the_delays_as_tf2_monitor_prints_them(log):
    for stamp_s, delay_s in ((1.3, 0.02), (1.4, 0.04)):
        log.add("base", "arm", stamp_s, RigidTransform(), static=False, delay_s=delay_s)
    everything = "\n".join(describe_delays(log, []))
    assert everything.startswith("RESULTS: for all Frames\n\nFrames:\nFrame: arm, published by <")
    assert "Frame: arm, published by <default_authority>, Average Delay: 0.012, Max" in everything
    assert "Frame: hand, published by <default_authority>, static" in everything
    assert "All Broadcasters:\nNode: <default_authority> 10 Hz, Average Delay: 0.012" in everything
    between = list(describe_delays(log, ["camera", "hand"]))
    assert between[:3] == [
        "RESULTS: for camera to hand",
        "Chain is: camera -> base -> arm -> hand",
        "Net delay     avg = 0.012: max = 0.04",
    ]
    assert any(line.startswith("Frame: camera, ") for line in between)
    assert "Frame: camera" not in "\n".join(describe_delays(log, ["base", "hand"]))
    with pytest.raises(NoSuchNameError, match="no frame 'hnd'"):
        list(describe_delays(log, ["base", "hnd"]))
