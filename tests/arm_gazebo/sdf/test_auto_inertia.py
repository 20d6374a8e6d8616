"""Mass and inertia computed from collisions and their densities."""

import math

import numpy as np
import pytest

from arm_gazebo.build_report import BuildReport
from arm_gazebo.errors import WorldError
from arm_gazebo.sdf.world import read_sdf_world

CUBE = "<box><size>1 1 1</size></box>"
CORNERS = "v 0 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 0\n"
TETRAHEDRON = f"{CORNERS}f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
FLAT = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n"


def ring():
    """Return a cube with a square hole from top to bottom, which leaves 7/16 of its volume."""
    square = ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))
    lines = [f"v {s * x} {s * y} {z}" for s in (1, 0.75) for z in (0, 1) for x, y in square]
    for i, j in ((0, 1), (1, 2), (2, 3), (3, 0)):
        outside, inside = (1 + i, 1 + j, 5 + j, 5 + i), (9 + j, 9 + i, 13 + i, 13 + j)
        bottom, top = (1 + j, 1 + i, 9 + i, 9 + j), (5 + i, 5 + j, 13 + j, 13 + i)
        for a, b, c, d in (outside, inside, bottom, top):
            lines += [f"f {a} {b} {c}", f"f {a} {c} {d}"]
    return "\n".join(lines)


def collision(geometry, density=None, pose="0 0 0 0 0 0"):
    said = "" if density is None else f"<density>{density}</density>"
    return (
        f'<collision name="c{pose}"><pose>{pose}</pose>{said}<geometry>{geometry}</geometry>'
        "</collision>"
    )


@pytest.fixture
def link(tmp_path):
    def made(*collisions, inside="", static=False):
        (tmp_path / "tetrahedron.obj").write_text(TETRAHEDRON)
        (tmp_path / "open.obj").write_text(TETRAHEDRON.replace("f 1 3 2\n", ""))
        (tmp_path / "ring.obj").write_text(ring())
        (tmp_path / "flat.obj").write_text(FLAT)
        path = tmp_path / "lab.sdf"
        path.write_text(
            f'<sdf version="1.11"><world name="lab"><model name="m"><static>{static}</static>'
            f'<link name="l"><inertial auto="true">{inside}</inertial>{"".join(collisions)}'
            "</link></model></world></sdf>"
        )
        report = BuildReport()
        return read_sdf_world(path, report).compile().body("m::l"), report

    return made


def mesh(name):
    return f"<mesh><uri>{name}.obj</uri></mesh>"


def test_the_mass_of_a_cube_follows_from_its_density(link):
    body, report = link(collision("<box><size>.1 .1 .1</size></box>", 2000))
    assert body.mass[0] == pytest.approx(2.0)
    assert body.inertia == pytest.approx(2.0 * 0.01 / 6)
    assert report.findings == ()


@pytest.mark.parametrize(
    ("geometry", "volume"),
    [
        (CUBE, 1.0),
        ("<sphere><radius>1</radius></sphere>", 4 / 3 * math.pi),
        ("<cylinder><radius>1</radius><length>2</length></cylinder>", 2 * math.pi),
        ("<capsule><radius>1</radius><length>2</length></capsule>", (2 + 4 / 3) * math.pi),
        (mesh("tetrahedron"), 1 / 6),
        (mesh("ring"), 7 / 16),
        (mesh("open"), 1 / 6),
    ],
)
def test_volumes_of_water(link, geometry, volume):
    body, report = link(collision(geometry))
    assert body.mass[0] == pytest.approx(1000 * volume)
    assert report.warnings == ()


def test_collisions_of_two_densities_about_their_common_centre(link):
    body, _ = link(
        collision(CUBE, 4, "0 0 0.5 0 0 0"),
        collision("<box><size>1 1 2</size></box>", 1, "0 0 -1 0 0 0"),
        inside="<pose>1 1 1 2 2 2</pose><inertia><ixx>7</ixx></inertia>",
    )
    assert body.mass[0] == pytest.approx(6.0)
    assert body.ipos == pytest.approx(np.zeros(3), abs=1e-9)
    assert sorted(body.inertia) == pytest.approx([1.0, 4.5, 4.5])


def test_a_stated_mass_scales_and_a_stated_density_is_for_all_collisions(link):
    body, _ = link(collision(CUBE), inside="<mass>12</mass>")
    assert (body.mass[0], body.inertia[0]) == pytest.approx((12.0, 2.0))
    body, _ = link(collision(CUBE, 3), collision(CUBE), inside="<density>5</density>")
    assert body.mass[0] == pytest.approx(8.0)


@pytest.mark.parametrize("collisions", ["", collision(mesh("flat"))])
def test_a_link_without_a_volume_gets_the_default_inertia_and_a_warning(link, collisions):
    body, report = link(collisions)
    assert (body.mass[0], body.inertia[0]) == (1.0, 1.0)
    assert "needs a collision with a volume, and it has none; 1 kg and 1 kg m2 are used" in str(
        report.warnings[0]
    )


def test_a_static_model_needs_no_inertia(link):
    assert link(static=True)[1].warnings == ()


@pytest.mark.parametrize(
    ("collisions", "inside"), [(collision(CUBE, -1), ""), (collision(CUBE), "<mass>0</mass>")]
)
def test_what_is_not_above_0_is_refused(link, collisions, inside):
    with pytest.raises(WorldError, match=r"it must be above 0"):
        link(collisions, inside=inside)
