"""The memory of an MJCF is estimated before MuJoCo allocates it."""

import struct

import mujoco
import pytest

from arm_gazebo.errors import ModelError, WorldError
from arm_gazebo.mjcf.memory_limit import MemoryLimit
from arm_gazebo.mjcf.size import check_mjcf_size
from arm_gazebo.model.world_file import load_world

LIMIT = MemoryLimit(500.0, "world_memory_limit")
WORLD = "<mujoco>{outside}<asset>{assets}</asset><worldbody>{inside}</worldbody></mujoco>"


def mjcf(assets="", inside="", outside=""):
    return WORLD.format(assets=assets, inside=inside, outside=outside)


def refusal(text, path=None, limit=LIMIT):
    with pytest.raises(ModelError) as caught:
        check_mjcf_size(text, "it", path, limit)
    return str(caught.value)


@pytest.mark.parametrize(
    ("text", "asked"),
    [
        (mjcf('<hfield name="h" nrow="20000" ncol="20000"/>'), "8000 MB, most of it for hfield"),
        (mjcf('<texture name="t" type="2d" width="20000" height="20000"/>'), "texture 't'"),
        (mjcf('<texture name="t" builtin="flat" width="9000"/>'), "3888 MB, most of it for"),
        (mjcf(outside='<sensor><user name="u" dim="2000000000"/></sensor>'), "user 'u'"),
        (mjcf(outside='<size memory="100G"/>'), "107374 MB"),
        (mjcf(outside='<size nuser_geom="50000000"/>'), "for <size> (line 1)"),
        (mjcf(outside='<size nuserdata="500000000"/>'), "for <size> (line 1)"),
        (mjcf('<mesh name="m" builtin="supersphere" params="5000 1 1"/>'), "for mesh 'm'"),
        (mjcf('<mesh name="m" builtin="plate" params="10 300000"/>'), "for mesh 'm'"),
        (mjcf(outside='<sensor><contact geom1="g" num="100000000"/></sensor>'), "for <contact>"),
        (mjcf(outside='<sensor><jointpos joint="j" nsample="16777216"/></sensor>'), "<jointpos>"),
        (mjcf(outside='<actuator><general joint="j" actdim="50000000"/></actuator>'), "<general>"),
        (
            mjcf(
                inside='<camera name="c" resolution="20000 20000"/>',
                outside='<sensor><rangefinder camera="c"/></sensor>',
            ),
            "for <rangefinder>",
        ),
        (mjcf(inside='<flexcomp name="f" count="100 100 100"/>'), "flexcomp 'f'"),
        (mjcf('<hfield name="h" nrow="1e400" ncol="9"/>' + '<hfield nrow="1e9" ncol="1e9"/>'), ""),
    ],
)
def test_what_asks_for_most_is_named(text, asked):
    message = refusal(text)
    assert asked in message
    assert "at most 500 MB are allowed (parameter world_memory_limit)" in message


@pytest.mark.parametrize(
    "inside",
    [
        '<replicate count="100000"><geom size="1"/></replicate>',
        '<replicate count="100"><replicate count="100"><geom size="1"/></replicate></replicate>',
        '<body><replicate count="2000"><body><geom/><site/></body></replicate></body>',
    ],
)
def test_copies_are_counted(inside):
    assert "copies; at most 5000 are compiled" in refusal(mjcf(inside=inside))


def test_what_a_file_includes_counts_with_its_copies(tmp_path):
    (tmp_path / "part.xml").write_text("<mujocoinclude><geom size='1'/></mujocoinclude>")
    inside = '<replicate count="9000"><include file="part.xml"/></replicate>'
    assert "make 18000 copies" in refusal(mjcf(inside=inside), tmp_path / "a.xml")


@pytest.mark.parametrize("asset", ['<hfield name="p" {}/>', '<texture name="p" type="2d" {}/>'])
def test_a_picture_counts_unpacked(tmp_path, asset):
    header = b"\x89PNG\r\n\x1a\n" + struct.pack(">I4sII", 13, b"IHDR", 30_000, 30_000)
    (tmp_path / "p.png").write_bytes(header)
    assert "'p'" in refusal(mjcf(asset.format('file="p.png"')), tmp_path / "a.xml")


@pytest.mark.parametrize(
    ("text", "what", "count"),
    [
        (
            mjcf('<hfield name="h" nrow="1000" ncol="1000" size="1 1 1 1"/>'),
            "nhfielddata",
            1_000_000,
        ),
        (
            mjcf('<texture name="t" builtin="gradient" type="skybox" width="512" height="3072"/>'),
            "ntexdata",
            3 * 512 * 3072,
        ),
        (mjcf(inside='<replicate count="100"><geom size="1"/></replicate>'), "ngeom", 100),
        (mjcf('<mesh name="m" builtin="supersphere" params="60 1 1"/>'), "nmesh", 1),
        (mjcf(inside='<camera resolution="9000 9000"/>'), "ncam", 1),
        (mjcf(outside='<size memory="100M"/>'), "narena", 100 * 2**20),
    ],
)
def test_ordinary_sizes_are_allowed_and_compiled(text, what, count):
    check_mjcf_size(text, "it", None, LIMIT)
    assert getattr(mujoco.MjSpec.from_string(text).compile(), what) == count


def test_the_limit_is_the_callers():
    text = mjcf('<hfield name="h" nrow="1000" ncol="1000" size="1 1 1 1"/>')
    assert "at most 10 MB are allowed (parameter p)" in refusal(text, limit=MemoryLimit(10.0, "p"))


def test_a_world_is_measured_before_it_is_read(tmp_path):
    (tmp_path / "w.xml").write_text(mjcf('<hfield name="h" nrow="20000" ncol="20000"/>'))
    with pytest.raises(WorldError, match=r"w\.xml is not usable .*needs about 8000 MB") as caught:
        load_world(tmp_path / "w.xml")
    assert str(caught.value).count("w.xml") == 1
