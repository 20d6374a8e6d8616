"""`arm gz`: what needs no simulation."""

from contextlib import suppress
from types import SimpleNamespace

import pytest

from arm_cli.gz import pose_lines, pose_of, text_of, time_of
from arm_cli.main import main
from arm_cli.verbs import ARM


def pose(x=0.0, y=0.0, z=0.0, w=1.0):
    return SimpleNamespace(
        position=SimpleNamespace(x=x, y=y, z=z),
        orientation=SimpleNamespace(x=0.0, y=0.0, z=(1 - w * w) ** 0.5, w=w),
    )


def test_messages_are_printed_as_protobuf_does_without_zeros():
    message = {"sim": time_of(12.25), "pose": [pose_of("box", 3, pose(x=0.5))]}
    assert text_of(message) == (
        "sim {\n  sec: 12\n  nsec: 250000000\n}\n"
        'pose {\n  name: "box"\n  id: 3\n  position {\n    x: 0.5\n  }\n'
        "  orientation {\n    w: 1\n  }\n}\n"
    )


def test_a_model_s_pose_is_printed_as_gz_does():
    assert pose_lines("box", 3, pose(x=1.0, w=0.5**0.5)) == [
        "Model: [3]",
        "  - Name: box",
        "  - Pose [ XYZ (m) ] [ RPY (rad) ]:",
        "      [1.000000 0.000000 0.000000]",
        "      [0.000000 0.000000 1.570796]",
    ]


@pytest.mark.parametrize(
    ("words", "launched"),
    [
        (["house.world"], ["gz_args:=-r house.world", "viewer:=true"]),
        (["-r", "-s", "-v", "4", "empty.sdf"], ["gz_args:=-r -s -v 4 empty.sdf", "viewer:=false"]),
        (
            ["shapes.sdf", "viewer_port:=8090"],
            ["gz_args:=-r shapes.sdf", "viewer:=true", "viewer_port:=8090"],
        ),
    ],
)
def test_sim_launches_a_world_with_the_page(monkeypatch, words, launched):
    lines: list[list[str]] = []
    monkeypatch.setattr("arm_cli.launch.launch", lambda line: lines.append(list(line)) or 0)
    assert main(["gz", "sim", *words]) == 0
    assert lines == [["ros_gz_sim", "gz_sim.launch.py", *launched]]


@pytest.mark.parametrize(
    "name", [verb.name for family in ARM.verbs if family.name == "gz" for verb in family.verbs]
)
def test_every_command_explains_itself(capsys, name):
    with suppress(SystemExit):
        main(["gz", name, "--help"])
    assert capsys.readouterr().out.startswith(f"usage: arm gz {name}")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["topic"], "give -l, -i -t NAME or -e -t NAME"),
        (["topic", "-e"], "which topic? Give -t NAME"),
        (["model"], "give --list, or -m NAME"),
        (["service"], "give -l, or -s NAME"),
    ],
)
def test_what_is_missing_is_said(capsys, words, said):
    assert main(["gz", *words]) == 2
    assert said in capsys.readouterr().err
