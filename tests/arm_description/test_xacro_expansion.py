"""xacro to URDF: arguments, $(find) without any environment, and errors as sentences."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from arm_description import XacroError, expand_xacro, parse_urdf
from arm_description.xacro_expansion import expand_xacro_file

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
    """As they lie in a workspace, or in a folder that somebody downloaded."""
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


def test_a_plain_urdf_passes_through_as_it_is(tmp_path):
    file = tmp_path / "a.urdf"
    file.write_text("<robot name='${not xacro}'><!-- kept --></robot>")
    assert expand_xacro(file) == "<robot name='${not xacro}'><!-- kept --></robot>"


@pytest.mark.parametrize("site", ["www.ros.org/wiki", "ros.org/wiki", "wiki.ros.org"])
def test_a_urdf_that_declares_xacro_is_expanded(tmp_path, site):
    file = write(tmp_path / "a.urdf", "<link name='${1 + 1}'/>")
    file.write_text(file.read_text().replace("www.ros.org/wiki", site))
    assert parse_urdf(expand_xacro(file)).root == "2"


def test_a_missing_file_is_named(tmp_path):
    path = tmp_path / "none.xacro"
    assert refusal(path) == f"cannot read {path}: No such file or directory"


def test_a_folder_is_no_file(tmp_path):
    assert refusal(tmp_path) == f"cannot read {tmp_path}: Is a directory"


def test_a_file_that_is_no_text_is_named(tmp_path):
    path = tmp_path / "a.xacro"
    path.write_bytes(b"\xff\xfe\x00")
    assert refusal(path).startswith(f"cannot read {path}: 'utf-8' codec")


@pytest.mark.parametrize(
    ("inside", "problem"),
    [
        ("<link name='${nothing}'/>", "name 'nothing' is not defined"),
        ("<link name='${1 / 0}'/>", "division by zero"),
        ("<link name='$(arg nothing)'/>", "nothing"),
        ("<xacro:include filename='none.xacro'/>", "No such file"),
        ("<xacro:include filename='$(find no_such_package)/a'/>", "no_such_package"),
        ("<xacro:unknown/>", "unknown macro name: xacro:unknown"),
        ("<link>", "mismatched tag"),
        ("<xacro:include filename='a.xacro'/>", "recursion"),
    ],
)
def test_what_xacro_stumbles_over_is_a_sentence_with_the_file(tmp_path, inside, problem):
    path = write(tmp_path / "a.xacro", inside)
    message = refusal(path)
    assert message.startswith(f"cannot expand {path}: ")
    assert problem in message
    assert "\n" not in message


def test_an_error_in_a_macro_names_the_macro_and_its_file(tmp_path):
    write(
        tmp_path / "inner.xacro",
        "<xacro:macro name='finger' params='n'><link name='${nothing}'/></xacro:macro>",
    )
    path = write(
        tmp_path / "outer.xacro",
        "<xacro:include filename='inner.xacro'/><xacro:finger n='1'/>",
    )
    message = refusal(path)
    assert "macro: finger" in message
    assert "inner.xacro" in message


def test_an_error_does_not_spoil_the_next_expansion(tmp_path):
    refusal(write(tmp_path / "bad.xacro", "<xacro:unknown/>"))
    good = write(tmp_path / "good.xacro", "<link name='a'/>")
    assert parse_urdf(expand_xacro(good)).root == "a"


def test_neither_xacro_nor_ros_is_imported_with_the_package():
    code = "import sys, arm_description; print([m for m in ('xacro', 'rclpy') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
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
    levels = "".join(f"<!ENTITY e{n + 1} '{f'&e{n};' * 20}'>" for n in range(20))
    (tmp_path / "b.xacro").write_text(
        f"<!DOCTYPE r [<!ENTITY e0 'x'>{levels}]>{HEAD}<link name='b'>&e20;</link></robot>"
    )
    assert "b.xacro" in refusal(outer)
    (tmp_path / "b.xacro").write_text(
        f"<!DOCTYPE r [<!ENTITY e SYSTEM 'file://{secret}'>]>{HEAD}<link>&e;</link></robot>"
    )
    assert "s3cret" not in expand_xacro(outer)


def test_files_that_include_each_other_for_ever_are_a_short_sentence(tmp_path):
    file = write(tmp_path / "a.xacro", "<xacro:include filename='a.xacro'/>")
    message = refusal(file)
    assert "recursion" in message
    assert message.endswith("...")
    assert len(message) < 1500


def test_a_missing_package_is_told_once_and_without_a_class(tmp_path):
    path = write(tmp_path / "a.xacro", "<xacro:include filename='$(find no_such_package)/a'/>")
    message = refusal(path)
    assert message.startswith(f"cannot expand {path}: no package 'no_such_package'; tried ")
    assert message.count("no package") == 1
