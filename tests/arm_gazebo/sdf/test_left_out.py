"""The count of elements of a world that the simulation lacks."""

import logging

import pytest

from arm_gazebo.build_report import BuildOutcome, BuildReport
from arm_gazebo.sdf.world import read_sdf_world

BODY = '<link name="l">{}</link>'
SHAPE = '<visual name="v"><geometry>{}</geometry></visual>'


def model(*parts, name="thing"):
    return f'<model name="{name}"><static>true</static>{"".join(parts)}</model>'


@pytest.fixture
def report(tmp_path):
    def of(*parts):
        path = tmp_path / "lab.sdf"
        path.write_text(f'<sdf version="1.9">\n<world name="lab">{"".join(parts)}</world></sdf>')
        found = BuildReport()
        read_sdf_world(path, found).compile()
        return found

    return of


@pytest.mark.parametrize(
    ("part", "named"),
    [
        ('<actor name="walker"/>', "actor 'walker'"),
        ('<light name="beam" type="laser"/>', "light 'beam'"),
        ('<plugin name="wind" filename="gz-sim-wind-effects-system"/>', "plugin 'wind'"),
        ('<road name="lane"/>', "road 'lane'"),
        (model('<joint name="hinge" type="revolute"/>', BODY.format("")), "joint 'hinge'"),
        (model(BODY.format(SHAPE.format("<heightmap/>"))), "<heightmap> of visual 'v'"),
        (model(BODY.format(SHAPE.format("<polyline/>"))), "<polyline> of visual 'v'"),
        (model(BODY.format('<sensor name="eye" type="camera"/>')), "sensor 'eye'"),
        (model(BODY.format('<particle_emitter name="fog"/>')), "particle_emitter 'fog'"),
        (model('<plugin name="p" filename="gz-sim-physics-system"/>', BODY.format("")), "'p'"),
        (
            model(BODY.format(SHAPE.format("<mesh><uri>model://no/a.dae</uri></mesh>"))),
            "link 'thing::l'",
        ),
    ],
)
def test_what_users_would_miss_is_a_warning_and_counted(report, part, named):
    found = report(part)
    assert found.left_out.startswith("1 thing is left out: ")
    assert named in found.left_out
    [finding] = found.findings
    assert (finding.outcome, finding.outcome.level) == (BuildOutcome.LEFT_OUT, logging.WARNING)


@pytest.mark.parametrize(
    "part",
    [
        '<gui><plugin name="view" filename="MinimalScene"/></gui>',
        '<physics type="ode"/><atmosphere type="adiabatic"/><magnetic_field>0 0 0</magnetic_field>',
        '<plugin name="p" filename="gz-sim-physics-system"/>',
        '<plugin name="p" filename="libignition-gazebo-scene-broadcaster-system.so"/>',
        '<plugin name="p" filename="gz-sim-user-commands-system"/>',
        '<plugin name="p" filename="libgazebo_ros_factory.so"/>',
        model('<joint name="weld" type="fixed"/>', BODY.format("")),
        model(BODY.format(SHAPE.format("<empty/>"))),
    ],
)
def test_irrelevant_elements_are_not_counted(report, part):
    found = report(part)
    assert found.left_out == ""
    assert found.warnings == ()


def test_a_frame_that_nothing_uses_is_not_missing(report):
    frames = '<frame name="near"><pose relative_to="__model__">0 0 1 0 0 0</pose></frame>'
    assert report(model(frames, BODY.format("")), frames).findings == ()


def test_things_alike_are_counted_each(report):
    walkers = "".join(f'<actor name="w{i}"/>' for i in range(86))
    assert report(walkers, '<road name="lane"/>').left_out == (
        "87 things are left out: actor 'w0' in lab.sdf and 85 more; road 'lane' in lab.sdf"
    )


def test_messages_add_the_folder_to_the_name_of_a_model_file(report, tmp_path):
    folder = tmp_path / "chair"
    folder.mkdir()
    joint = '<joint name="hinge" type="revolute"/>'
    (folder / "model.sdf").write_text(f'<sdf version="1.9">{model(joint, BODY.format(""))}</sdf>')
    found = report("<include><uri>chair</uri></include>")
    assert found.left_out == "1 thing is left out: joint 'hinge' in chair/model.sdf"
