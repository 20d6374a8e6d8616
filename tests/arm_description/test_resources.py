"""URIs to files: where they are searched, in which order, and what the error lists."""

import sys
from pathlib import Path

import pytest

from arm_description import ResourceNotFoundError, resolve_uri
from arm_description.package_search import share_folders
from arm_description.resources import ResourceFinder


def make(path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.touch()
    return path


def ament(*prefixes: Path) -> dict[str, str]:
    return {"AMENT_PREFIX_PATH": ":".join(map(str, prefixes))}


def test_a_package_is_found_in_the_first_prefix_that_has_the_file(tmp_path):
    make(tmp_path / "one/share/robot/other.stl")
    expected = make(tmp_path / "two/share/robot/meshes/a.stl")
    environ = ament(tmp_path / "one", tmp_path / "two")
    assert resolve_uri("package://robot/meshes/a.stl", environ=environ) == expected


def test_a_package_is_found_in_the_search_path_before_the_prefixes(tmp_path):
    behind = make(tmp_path / "prefix/share/robot/a.stl")
    search = [tmp_path / "source"]
    environ = ament(tmp_path / "prefix")
    assert resolve_uri("package://robot/a.stl", search, environ) == behind
    first = make(tmp_path / "source/robot/a.stl")
    assert resolve_uri("package://robot/a.stl", search, environ) == first


def test_the_search_path_may_name_the_package_itself(tmp_path):
    expected = make(tmp_path / "robot/meshes/a.stl")
    assert resolve_uri("package://robot/meshes/a.stl", [tmp_path / "robot"], {}) == expected


def test_this_pythons_own_prefix_is_searched_without_any_variable():
    assert share_folders({}) == [Path(sys.prefix) / "share"]
    assert resolve_uri("package://arm_description/package.xml", environ={}).is_file()


def test_a_folder_is_found_too(tmp_path):
    make(tmp_path / "share/robot/meshes/a.stl")
    folder = tmp_path / "share/robot/meshes"
    assert resolve_uri("package://robot/meshes", environ=ament(tmp_path)) == folder


def test_a_model_is_found_where_gazebos_users_put_it(tmp_path):
    expected = make(tmp_path / "models/box/meshes/a.dae")
    make(tmp_path / "share/box/meshes/a.dae")
    environ = {**ament(tmp_path), "GZ_SIM_RESOURCE_PATH": f":{tmp_path}/models"}
    assert resolve_uri("model://box/meshes/a.dae", environ=environ) == expected


def test_a_model_is_found_in_a_package(tmp_path):
    expected = make(tmp_path / "share/robot/meshes/a.dae")
    assert resolve_uri("model://robot/meshes/a.dae", environ=ament(tmp_path)) == expected


@pytest.mark.parametrize("file", ["a b.stl", "a%20b.stl"])
def test_a_uri_in_a_package_may_be_percent_encoded(tmp_path, file):
    expected = make(tmp_path / "share/robot/meshes" / file)
    assert resolve_uri("package://robot/meshes/a%20b.stl", environ=ament(tmp_path)) == expected


@pytest.mark.parametrize("host", ["", "localhost"])
def test_a_file_uri_may_be_percent_encoded(tmp_path, host):
    expected = make(tmp_path / "a b.stl")
    assert resolve_uri(f"file://{host}{tmp_path}/a%20b.stl") == expected


def test_a_plain_absolute_path(tmp_path):
    expected = make(tmp_path / "a.stl")
    assert resolve_uri(f" {expected} ") == expected


def test_a_relative_path_is_searched_in_order_then_in_the_working_folder(tmp_path, monkeypatch):
    here = make(tmp_path / "here/a.stl")
    monkeypatch.chdir(tmp_path / "here")
    search = [tmp_path / "one", tmp_path / "two"]
    assert resolve_uri("a.stl", search) == here
    second = make(tmp_path / "two/a.stl")
    assert resolve_uri("a.stl", search) == second


def test_an_error_names_every_place_tried_once(tmp_path):
    environ = ament(tmp_path / "one", tmp_path / "one", tmp_path / "two")
    with pytest.raises(ResourceNotFoundError) as caught:
        resolve_uri("package://robot/a.stl", [tmp_path / "src"], environ)
    assert str(caught.value) == (
        "no file for 'package://robot/a.stl'; tried:"
        f"\n  {tmp_path}/src/robot/a.stl"
        f"\n  {tmp_path}/one/share/robot/a.stl"
        f"\n  {tmp_path}/two/share/robot/a.stl"
        f"\n  {sys.prefix}/share/robot/a.stl"
    )


@pytest.mark.parametrize(
    ("uri", "message"),
    [
        ("", "'' names no file"),
        ("package://", "'package://' names no file"),
        ("package:///a.stl", "'package:///a.stl' names no package"),
        (
            "https://example.org/a.stl",
            "cannot read 'https://example.org/a.stl'; package://, model://, file:// "
            "and plain paths are supported",
        ),
    ],
)
def test_a_uri_without_a_file_is_reported(uri, message):
    with pytest.raises(ResourceNotFoundError) as caught:
        resolve_uri(uri)
    assert str(caught.value) == message


@pytest.mark.parametrize("name", ["a\x00b", "\ud800", "x" * 10_000])
def test_names_that_no_file_can_have_are_not_found(name):
    with pytest.raises(ResourceNotFoundError, match="no file for"):
        resolve_uri(f"package://robot/{name}")
    with pytest.raises(ResourceNotFoundError, match="no package"):
        ResourceFinder().package(name)


@pytest.mark.parametrize(
    "uri",
    [
        "package://robot/../other/a.stl",
        "package://robot/%2e%2E/other/a.stl",
        "package://robot/..%2Fother/a.stl",
        "model://robot/x/../../a.stl",
    ],
)
def test_a_uri_may_not_lead_out_of_its_package(tmp_path, uri):
    make(tmp_path / "share/other/a.stl")
    make(tmp_path / "share/a.stl")
    with pytest.raises(ResourceNotFoundError, match="leads out of the package 'robot'"):
        resolve_uri(uri, [tmp_path / "share"], ament(tmp_path))


def test_an_encoded_slash_does_not_start_an_absolute_path(tmp_path):
    outside = make(tmp_path / "a.stl")
    expected = make(tmp_path / f"share/robot{outside}")
    assert resolve_uri(f"package://robot/%2F{outside}", environ=ament(tmp_path)) == expected


@pytest.mark.parametrize("scheme", ["package", "model"])
def test_more_slashes_than_one_stay_within_the_package(tmp_path, scheme):
    expected = make(tmp_path / "share/robot/meshes/a.stl")
    outside = make(tmp_path / "a.stl")
    environ = ament(tmp_path) | {"GZ_SIM_RESOURCE_PATH": str(tmp_path / "share")}
    assert resolve_uri(f"{scheme}://robot//meshes//a.stl", environ=environ) == expected
    with pytest.raises(ResourceNotFoundError, match="no file for"):
        resolve_uri(f"{scheme}://robot/{outside}", environ=environ)


@pytest.mark.parametrize("name", [".", ".."])
def test_dots_are_not_a_package(tmp_path, name):
    with pytest.raises(ResourceNotFoundError, match="names no package"):
        resolve_uri(f"package://{name}/a.stl", [tmp_path], {})


def test_a_relative_path_may_climb_within_the_given_folders_only(tmp_path):
    expected = make(tmp_path / "robot/meshes/a.stl")
    make(tmp_path / "a.stl")
    folders = [tmp_path / "robot/urdf", tmp_path / "robot"]
    assert resolve_uri("../meshes/a.stl", folders, {}) == expected
    with pytest.raises(ResourceNotFoundError, match="leads out of"):
        resolve_uri("../../a.stl", folders[:1], {})


def manifest(folder: Path, name: str) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "package.xml").write_text(f"<package format='3'>\n  <name> {name} </name></package>")
    return folder


def test_a_repository_may_be_called_otherwise_than_its_package(tmp_path):
    package = manifest(tmp_path / "source/Robot_ROS2_Description", "robot")
    expected = make(package / "a.stl")
    assert resolve_uri("package://robot/a.stl", [package], {}) == expected
    assert resolve_uri("package://robot/a.stl", [tmp_path / "source"], {}) == expected
    with pytest.raises(ResourceNotFoundError):
        resolve_uri("package://arm/a.stl", [tmp_path / "source"], {})


def test_a_package_xml_that_is_not_text_has_no_name(tmp_path):
    (manifest(tmp_path / "folder", "robot") / "package.xml").write_bytes(b"\xff<name>robot</name>")
    with pytest.raises(ResourceNotFoundError, match="no package 'robot'; tried "):
        ResourceFinder(None, [tmp_path], {}).package("robot")


def test_a_package_is_found_where_gazebo_looks_for_it(tmp_path):
    expected = make(tmp_path / "source/robot/a.stl")
    environ = {"GZ_SIM_RESOURCE_PATH": f"{tmp_path}/source"}
    assert resolve_uri("package://robot/a.stl", environ=environ) == expected


def test_a_package_is_a_folder_of_an_installed_one_or_of_the_search_path(tmp_path):
    behind = make(tmp_path / "share/robot/a.stl").parent
    environ = ament(tmp_path)
    assert ResourceFinder(None, [tmp_path / "source"], environ).package("robot") == behind
    first = make(tmp_path / "source/robot/a.stl").parent
    assert ResourceFinder(None, [tmp_path / "source"], environ).package("robot") == first
