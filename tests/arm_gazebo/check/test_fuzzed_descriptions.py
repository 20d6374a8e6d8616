"""Corrupted descriptions and meshes always give a report, and never an exception."""

import base64
import json
import math
import re
from pathlib import Path

import pytest
import trimesh
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from arm_description.errors import XacroError
from arm_description.xacro.expansion import expand_xacro
from arm_gazebo.check.description import CheckResult, check_description
from arm_gazebo.robot.part import BuildOptions

FILES = sorted(Path(__file__).with_name("urdfs").glob("*.urdf"))
TEXTS = [file.read_text().partition("-->\n")[2] for file in FILES]
WORDS = re.compile(r"""(?<=")[^"<>]*(?=")|(?<=<)/?[\w:]+|(?<=>)[^<>]+(?=<)|[<>/="]""")
NASTY = st.sampled_from(
    [
        *("", " ", "0", "-0", "-1", "1e308", "-1e308", "1e-320", "1e400", "nan", "inf", "١٢"),
        *("1 2", "1 2 3 4", "0 0 0", "1e200 1e200 1e200", "a" * 5000, "\x7f", "ä", "🤖", "${x}"),
        *("world", "base", "arm", "j", "link", "joint", "robot", "gazebo", "mimic", "ros2_control"),
        *("fixed", "floating", "planar", "prismatic", "../..", "file:///dev/zero", "%00", "&amp;"),
        *("&lt;", "<", ">", "/", '"', "<!--", "-->", "<![CDATA[", "]]>", "<?x?>", "&e;"),
    ]
)
SETTINGS = settings(
    deadline=None,
    max_examples=30,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture],
)


@st.composite
def spoilt_texts(draw: st.DrawFn) -> str:
    """Return one of the hard URDFs with a few of its words replaced."""
    text = draw(st.sampled_from(TEXTS))
    places = [match.span() for match in WORDS.finditer(text)]
    chosen = draw(st.lists(st.sampled_from(places), min_size=1, max_size=4, unique=True))
    for start, end in sorted(chosen, reverse=True):
        text = text[:start] + draw(NASTY) + text[end:]
    return text


@st.composite
def spoilt_bytes(draw: st.DrawFn, content: bytes) -> bytes:
    """Return bytes with a few of them changed, left out, doubled or cut off."""
    data = bytearray(content)
    for _ in range(draw(st.integers(1, 4))):
        start = draw(st.integers(0, len(data)))
        length = draw(st.integers(0, 12))
        data[start : start + length] = draw(st.binary(max_size=12))
    return bytes(data)


def check(text: str) -> None:
    report = check_description(text, "robot.urdf")
    assert report.summary is not None or not report.is_usable
    assert all(str(finding) for finding in report.findings)
    if report.summary is not None:
        assert math.isfinite(report.summary.mass_kg)


@SETTINGS
@given(spoilt_texts())
def test_a_description_with_spoilt_words_is_reported(text):
    check(text)


@SETTINGS
@given(st.sampled_from(TEXTS).flatmap(lambda text: spoilt_bytes(text.encode())))
def test_a_description_with_spoilt_bytes_is_reported(data):
    check(data.decode("utf-8", "replace"))


XACRO = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="side" default="left"/><xacro:property name="n" value="${2 * 3}"/>
<xacro:macro name="part" params="name size:=1 *more"><link name="${name}_$(arg side)">
<xacro:insert_block name="more"/></link></xacro:macro>
<xacro:if value="${n > 3}"><xacro:part name="a"><visual/></xacro:part></xacro:if>
<xacro:unless value="$(eval 1 == 2)"><link name="b${n}"/></xacro:unless></robot>"""


@st.composite
def spoilt_xacros(draw: st.DrawFn) -> str:
    """Return a xacro text with a few of its words replaced."""
    places = [match.span() for match in re.finditer(r"\w+|\W", XACRO)]
    chosen = draw(st.lists(st.sampled_from(places), min_size=1, max_size=3, unique=True))
    text = XACRO
    for start, end in sorted(chosen, reverse=True):
        text = text[:start] + draw(NASTY) + text[end:]
    return text


@SETTINGS
@given(spoilt_xacros())
def test_a_spoilt_xacro_is_expanded_or_refused(tmp_path, text):
    file = tmp_path / "a.xacro"
    file.write_bytes(text.encode("utf-8", "replace"))
    try:
        outcome = expand_xacro(file)
    except XacroError as error:
        outcome = str(error)
    # The expanded text names its source in a comment.
    assert "a.xacro" in outcome


COLLADA = b"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 1 0 0 0 1 0 0 0 1</float_array>
<technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles></mesh></geometry></library_geometries>
<library_nodes><node id="m"><instance_geometry url="#g"/></node></library_nodes>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>1 0 0</translate>
<instance_node url="#m"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""
BOX = trimesh.creation.box([0.1, 0.2, 0.3])


def as_bytes(content: str | bytes) -> bytes:
    return content if isinstance(content, bytes) else content.encode()


def gltf_in_one_file() -> bytes:
    """Return a .gltf with embedded data."""
    files = BOX.export(file_type="gltf")
    document = json.loads(files["model.gltf"])
    for buffer in document["buffers"]:
        data = base64.b64encode(files[buffer["uri"]]).decode()
        buffer["uri"] = f"data:application/octet-stream;base64,{data}"
    return json.dumps(document).encode()


MESHES = {
    **{
        suffix: as_bytes(BOX.export(file_type=suffix))
        for suffix in ("stl", "obj", "ply", "glb", "off", "3mf")
    },
    "dae": COLLADA,
    "gltf": gltf_in_one_file(),
}


@st.composite
def spoilt_numbers(draw: st.DrawFn, content: bytes) -> bytes:
    """Return a text with a few of its words and numbers replaced."""
    text = content.decode()
    places = [match.span() for match in re.finditer(r"[\w.+-]+", text)]
    chosen = draw(st.lists(st.sampled_from(places), min_size=1, max_size=3, unique=True))
    for start, end in sorted(chosen, reverse=True):
        text = text[:start] + draw(NASTY | st.integers(-9, 99999).map(str)) + text[end:]
    return text.encode("utf-8", "replace")


@pytest.mark.filterwarnings("ignore")
@SETTINGS
@given(st.data())
@pytest.mark.parametrize("suffix", MESHES)
def test_a_mesh_with_spoilt_bytes_is_used_or_replaced(tmp_path, suffix, data):
    check_mesh(tmp_path, suffix, data.draw(spoilt_bytes(MESHES[suffix])))


@pytest.mark.filterwarnings("ignore")
@SETTINGS
@given(st.data())
@pytest.mark.parametrize("suffix", ["dae", "gltf"])
def test_a_mesh_with_spoilt_words_is_used_or_replaced(tmp_path, suffix, data):
    check_mesh(tmp_path, suffix, data.draw(spoilt_numbers(MESHES[suffix])))


@pytest.mark.parametrize("suffix", MESHES)
def test_the_meshes_that_are_spoilt_were_sound(tmp_path, suffix):
    findings = check_mesh(tmp_path, suffix, MESHES[suffix]).findings
    assert {finding.outcome.value for finding in findings} == {"note"}


def check_mesh(tmp_path: Path, suffix: str, content: bytes) -> CheckResult:
    file = tmp_path / f"mesh.{suffix}"
    file.write_bytes(content)
    shape = f'<geometry><mesh filename="{file}"/></geometry>'
    urdf = (
        f'<robot name="r"><link name="a"><visual>{shape}</visual><collision>{shape}</collision>'
        "</link></robot>"
    )
    report = check_description(urdf, "robot.urdf", BuildOptions(mesh_cache=tmp_path / "cache"))
    assert report.is_usable, report.findings
    return report
