"""xacro to URDF: arguments, $(find) without any environment, and errors as sentences."""

import os
import sys
from pathlib import Path

import pytest
from run_python import run_python

from arm_description import XacroError, expand_xacro, parse_urdf
from arm_description.xacro.expansion import expand_xacro_file

HEAD = "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'>"


def write(path: Path, inside: str) -> Path:
    path.parent.mkdir(exist_ok=True)
    path.write_text(f"{HEAD}\n{inside}\n</robot>")
    return path


def refusal(path: Path) -> str:
    with pytest.raises(XacroError) as caught:
        expand_xacro(path)
    return str(caught.value)


def test_arguments_and_their_defaults(tmp_path):
    file = write(
        tmp_path / "a.urdf.xacro",
        "<xacro:arg name='prefix' default='x_'/><link name='$(arg prefix)a'/>",
    )
    assert parse_urdf(expand_xacro(file)).root == "x_a"
    assert parse_urdf(expand_xacro(file, {"prefix": "left_"})).root == "left_a"


def test_a_file_may_be_named_by_text(tmp_path):
    file = write(tmp_path / "a.xacro", "<link name='a'/>")
    assert parse_urdf(expand_xacro(str(file))).root == "a"


def test_find_works_without_ament_prefix_path(tmp_path, monkeypatch):
    monkeypatch.delenv("AMENT_PREFIX_PATH")
    file = write(tmp_path / "a.xacro", "<link name='$(find arm_description)'/>")
    assert parse_urdf(expand_xacro(file)).root == f"{sys.prefix}/share/arm_description"
    assert "AMENT_PREFIX_PATH" not in os.environ


def test_find_prefers_the_users_prefixes_and_leaves_the_variable_alone(tmp_path, monkeypatch):
    marker = tmp_path / "share/ament_index/resource_index/packages/arm_description"
    marker.parent.mkdir(parents=True)
    marker.touch()
    (tmp_path / "share/arm_description").mkdir()
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    file = write(tmp_path / "a.xacro", "<link name='$(find arm_description)'/>")
    assert parse_urdf(expand_xacro(file)).root == f"{tmp_path}/share/arm_description"
    assert os.environ["AMENT_PREFIX_PATH"] == str(tmp_path)


def test_find_knows_the_files_own_package_and_its_neighbours(tmp_path):
    """As in a workspace, or in a downloaded folder."""
    for folder, name in (("Arm_Description", "arm_x"), ("hand_x", "hand_x")):
        (tmp_path / folder / "urdf").mkdir(parents=True)
        (tmp_path / folder / "package.xml").write_text(f"<package><name>{name}</name></package>")
        write(tmp_path / folder / "urdf/part.xacro", f"<link name='{name}'/>")
    (tmp_path / "Arm_Description/limits.yaml").write_text("reach: !degrees 180\n")
    file = write(
        tmp_path / "Arm_Description/urdf/a.xacro",
        "<xacro:include filename='$(find arm_x)/urdf/part.xacro'/>"
        "<xacro:include filename='$(find hand_x)/urdf/part.xacro'/>"
        "<xacro:property name='own' value='$(find arm_x)/limits.yaml'/>"
        "<link name=\"${round(xacro.load_yaml(own)['reach'], 2)}\"/>",
    )
    text = expand_xacro(file)
    assert all(f'name="{name}"' in text for name in ("arm_x", "hand_x", "3.14"))


def test_find_looks_in_the_folders_given(tmp_path):
    (tmp_path / "elsewhere/far_x").mkdir(parents=True)
    file = write(tmp_path / "one" / "a.xacro", "<link name='$(find far_x)'/>")
    with pytest.raises(XacroError, match="no package 'far_x'; tried "):
        expand_xacro_file(file)
    expansion = expand_xacro_file(file, package_path=[tmp_path / "elsewhere"])
    assert parse_urdf(expansion.text).root == f"{tmp_path}/elsewhere/far_x"


def test_a_plain_urdf_is_unchanged_except_for_its_source(tmp_path):
    file = tmp_path / "a.urdf"
    file.write_text("<robot name='${not xacro}'><!-- kept --></robot>")
    assert expand_xacro(file) == (
        f"<?description_source {file.as_uri()}?><robot name='${{not xacro}}'><!-- kept --></robot>"
    )


@pytest.mark.parametrize("site", ["www.ros.org/wiki", "ros.org/wiki", "wiki.ros.org"])
def test_a_urdf_that_declares_xacro_is_expanded(tmp_path, site):
    file = write(tmp_path / "a.urdf", "<link name='${1 + 1}'/>")
    file.write_text(file.read_text().replace("www.ros.org/wiki", site))
    assert parse_urdf(expand_xacro(file)).root == "2"


def test_a_missing_file_is_named(tmp_path):
    path = tmp_path / "none.xacro"
    assert refusal(path) == f"cannot read {path}: No such file or directory"


def test_a_folder_is_not_a_file(tmp_path):
    assert refusal(tmp_path) == f"cannot read {tmp_path}: it is a folder, not a regular file"


def test_a_file_that_is_not_text_is_named(tmp_path):
    path = tmp_path / "a.xacro"
    path.write_bytes(b"\xff\xfe\x00")
    assert refusal(path).startswith(f"cannot read {path}: 'utf-8' codec")


@pytest.mark.parametrize(
    ("inside", "problem"),
    [
        ("<link name='${nothing}'/>", "name 'nothing' is not defined"),
        ("<link name='${1 / 0}'/>", "division by zero"),
        ("<link name='$(arg nothing)'/>", "nothing"),
        ("<xacro:include filename='$(find no_such_package)/a'/>", "no_such_package"),
        ("<xacro:unknown/>", "unknown macro name: xacro:unknown"),
        ("<link>", "mismatched tag"),
        ("<xacro:include filename='a.xacro'/>", "the recursion does not end"),
    ],
)
def test_what_xacro_stumbles_over_is_a_sentence_with_the_file(tmp_path, inside, problem):
    path = write(tmp_path / "a.xacro", inside)
    message = refusal(path)
    line = 3 if inside == "<link>" else 2
    assert message.startswith(f"cannot expand {path}, line {line}: ")
    assert problem in message
    assert "\n" not in message
    assert message.count(str(path)) == 1


def test_an_included_file_that_does_not_exist_is_named_once(tmp_path):
    path = write(tmp_path / "a.xacro", "<xacro:include filename='none.xacro'/>")
    assert refusal(path) == (
        f"cannot expand {path}, line 2: cannot read {tmp_path / 'none.xacro'}: "
        "No such file or directory"
    )


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        ("$(env NO_SUCH_VARIABLE)", "environment variable 'NO_SUCH_VARIABLE' is not set"),
        ("$(eval 1 +)", "invalid syntax (<string>, line 1)"),
        ("${1/0}", "division by zero"),
    ],
)
def test_the_reason_of_an_error_comes_once(tmp_path, value, reason):
    file = write(tmp_path / "robot.xacro", f'<link name="{value}"/>')
    assert refusal(file) == f"cannot expand {file}, line 2: {reason}"


def test_an_error_in_a_macro_names_the_macro_its_file_and_its_line(tmp_path):
    inner = write(
        tmp_path / "inner.xacro",
        "<xacro:macro name='finger' params='n'>\n  <link name='a'/>\n"
        "  <xacro:if value='1'><link name='${nothing}'/></xacro:if></xacro:macro>\n"
        "<xacro:macro name='hand' params=''><xacro:finger n='1'/></xacro:macro>",
    )
    path = write(tmp_path / "outer.xacro", "<xacro:include filename='inner.xacro'/>\n<xacro:hand/>")
    assert refusal(path) == (
        f"cannot expand {path}: {inner}, line 4: name 'nothing' is not defined; in macro: finger, "
        "in macro: hand"
    )


@pytest.mark.parametrize(
    ("inside", "reason"),
    [("<link name='${x}'/>", "name 'x' is not defined"), ("</a>", "mismatched tag")],
)
def test_an_error_in_an_included_file_names_every_file_once(tmp_path, inside, reason):
    inner = write(tmp_path / "inner.xacro", f"\n\n{inside}")
    middle = write(tmp_path / "middle.xacro", "<xacro:include filename='inner.xacro'/>")
    path = write(tmp_path / "outer.xacro", "<xacro:include filename='middle.xacro'/>")
    assert refusal(path) == (
        f"cannot expand {path}: {inner}, line 4: {reason}; included from: {middle}"
    )


def test_an_error_does_not_spoil_the_next_expansion(tmp_path):
    refusal(write(tmp_path / "bad.xacro", "<xacro:unknown/>"))
    good = write(tmp_path / "good.xacro", "<link name='a'/>")
    assert parse_urdf(expand_xacro(good)).root == "a"


def test_neither_xacro_nor_ros_is_imported_with_the_package():
    code = "import sys, arm_description; print([m for m in ('xacro', 'rclpy') if m in sys.modules])"
    done = run_python("-c", code, check=True)
    assert done.stdout == "[]\n"


def test_a_doctype_is_refused_but_not_one_in_a_comment(tmp_path):
    file = tmp_path / "a.xacro"
    file.write_text(f"<!DOCTYPE robot>{HEAD}<link name='a'/></robot>")
    assert refusal(file) == f"{file} has a DOCTYPE, which is not accepted; remove it"
    file.write_text(f"<!-- <!DOCTYPE robot> -->{HEAD}<link name='a'/></robot>")
    assert parse_urdf(expand_xacro(file)).root == "a"


def test_entities_of_an_included_file_neither_multiply_nor_read_files(tmp_path):
    secret = tmp_path / "secret.txt"
    secret.write_text("s3cret")
    inside = "<xacro:include filename='b.xacro'/>"
    outer = write(tmp_path / "a.xacro", inside)
    (tmp_path / "b.xacro").write_text(
        f"<!DOCTYPE r [<!ENTITY a 'x'><!ENTITY b '&a;&a;'>]>{HEAD}<link name='b'>&b;</link></robot>"
    )
    assert "it has a DOCTYPE, which is not accepted" in refusal(outer)
    (tmp_path / "b.xacro").write_text(
        f"<!DOCTYPE r [<!ENTITY e SYSTEM 'file://{secret}'>]>{HEAD}<link>&e;</link></robot>"
    )
    assert "it has a DOCTYPE, which is not accepted" in refusal(outer)


def test_files_that_include_each_other_give_a_short_message(tmp_path):
    file = write(tmp_path / "a.xacro", "<xacro:include filename='a.xacro'/>")
    message = refusal(file)
    assert "recursion" in message
    assert len(message) < 300


def test_a_missing_package_is_reported_once_without_a_class_name(tmp_path):
    path = write(tmp_path / "a.xacro", "<xacro:include filename='$(find no_such_package)/a'/>")
    message = refusal(path)
    assert message.startswith(f"cannot expand {path}, line 2: no package 'no_such_package'; tried ")
    assert message.count("no package") == 1


@pytest.mark.parametrize(
    "body",
    [
        "<xacro:include filename='{file}'/>",
        '<xacro:property name="d" value="${{xacro.load_yaml(\'{file}\')}}"/><link name="${{d}}"/>',
    ],
)
def test_included_fifos_and_devices_are_refused(tmp_path, body):
    os.mkfifo(tmp_path / "fifo")
    for file, kind in ((tmp_path / "fifo", "FIFO"), (Path("/dev/zero"), "device")):
        message = refusal(write(tmp_path / "a.xacro", body.format(file=file)))
        assert f"{file}: it is a {kind}, not a regular file" in message


def test_yaml_of_a_xacro_is_read_within_limits(tmp_path):
    aliases = [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]" for n in range(1, 12)]
    body = "<xacro:property name='d' value='${xacro.load_yaml(\"d.yaml\")}'/><link name='${d.w}'/>"
    (tmp_path / "d.yaml").write_text("w: !degrees 180")
    assert "3.14159" in expand_xacro(write(tmp_path / "a.xacro", body))
    (tmp_path / "d.yaml").write_text("\n".join(["a0: &a0 x", *aliases]))
    assert "has more than 1000000 values" in refusal(tmp_path / "a.xacro")
