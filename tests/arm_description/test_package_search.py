"""Which of several packages of one name counts: the user's before the suite's."""

import sys
from pathlib import Path

import pytest

from arm_description import ResourceFinder, ResourceNotFoundError, package_search
from arm_description.package_search import AMENT, BESIDE, GIVEN, OWN, SUITE, suite_package

URI = "package://arm_description/meshes/a.stl"
SUITES = Path(sys.prefix) / "share" / "arm_description"
"""The suite has a package of that name, too."""


def package(folder: Path, name: str = "arm_description", mesh: str = "meshes/a.stl") -> Path:
    """Make a package with a mesh and a description; return the mesh."""
    for path in (folder / mesh, folder / "urdf/arm.urdf"):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    (folder / "package.xml").write_text(f"<package format='3'><name>{name}</name></package>")
    return folder / mesh


def ament(*prefixes: Path) -> dict[str, str]:
    return {"AMENT_PREFIX_PATH": ":".join(map(str, prefixes))}


def origins(finder: ResourceFinder) -> dict[str, list[str]]:
    return {name: [place.origin for place in places] for name, places in finder.used.items()}


def test_the_order_of_all_places(tmp_path):
    ws = tmp_path / "ws"
    given = tmp_path / "given"
    gazebo = tmp_path / "gazebo"
    beside, file = package(ws / "beside"), ws / "mine/urdf/arm.urdf"
    meshes = {
        OWN: package(ws / "mine"),
        GIVEN: package(given / "deep" / "any_name"),
        BESIDE: beside,
        AMENT: package(tmp_path / "install/share/arm_description"),
    }
    package(gazebo / "arm_description")
    environ = {**ament(Path(sys.prefix), tmp_path / "install"), "GZ_SIM_RESOURCE_PATH": str(gazebo)}
    for origin, mesh in meshes.items():
        finder = ResourceFinder(file, [given], environ)
        assert finder.find(URI) == mesh
        assert finder.package("arm_description") == mesh.parent.parent
        assert origins(finder) == {"arm_description": [origin]}
        (mesh.parent.parent / "package.xml").unlink()
        mesh.unlink()
        mesh.parent.rmdir()
        mesh.parent.parent.rename(tmp_path / f"gone {len(list(tmp_path.iterdir()))}")
        (ws / "mine/urdf").mkdir(parents=True, exist_ok=True)
    finder = ResourceFinder(file, [given], environ)
    assert finder.find(URI) == gazebo / "arm_description/meshes/a.stl"
    finder = ResourceFinder(file, [given], ament(tmp_path / "install"))
    assert finder.package("arm_description") == SUITES
    assert origins(finder) == {"arm_description": [SUITE]}


def test_the_suites_prefix_comes_last_wherever_the_variable_has_it(tmp_path):
    mesh = package(tmp_path / "share/arm_description")
    assert ResourceFinder(None, (), ament(Path(sys.prefix), tmp_path)).find(URI) == mesh


def test_a_link_to_the_suites_prefix_is_the_suites_prefix(tmp_path):
    (tmp_path / "link").symlink_to(sys.prefix)
    mesh = package(tmp_path / "ws/share/arm_description")
    assert ResourceFinder(None, (), ament(tmp_path / "link", tmp_path / "ws")).find(URI) == mesh


def test_the_suite_finds_its_own_files_beside_a_users_package_of_that_name(tmp_path):
    package(tmp_path / "share/arm_description")
    assert suite_package("arm_description", ament(tmp_path)) == SUITES
    assert suite_package("hand", ament(tmp_path)) is None


def test_a_suite_in_a_workspace_is_found_by_ament(tmp_path):
    package(tmp_path / "share/hand", "hand")
    assert suite_package("hand", ament(tmp_path)) == tmp_path / "share/hand"


def test_a_mesh_missing_from_the_users_package_is_not_taken_from_the_suite(tmp_path):
    package(tmp_path / "arm_description", mesh="meshes/other.stl")
    [mesh] = sorted((SUITES / "meshes").glob("*.stl"))[:1]
    uri = f"package://arm_description/meshes/{mesh.name}"
    assert ResourceFinder(None, (), {}).find(uri) == mesh
    finder = ResourceFinder(tmp_path / "arm_description/urdf/arm.urdf", (), {})
    with pytest.raises(ResourceNotFoundError) as caught:
        finder.find(uri)
    assert str(SUITES) not in str(caught.value)


def test_files_missing_from_a_source_package_are_found_in_the_installed_one(tmp_path):
    """Meshes that the build makes are only there."""
    package(tmp_path / "src/mine", "mine", "meshes/other.stl")
    made = package(tmp_path / "install/share/mine", "mine")
    finder = ResourceFinder(tmp_path / "src/mine/urdf/arm.urdf", (), ament(tmp_path / "install"))
    assert finder.find("package://mine/meshes/a.stl") == made


def test_a_workspace_that_is_not_sourced_has_neighbours(tmp_path):
    for name in ("mine", "hand"):
        package(tmp_path / f"install/{name}/share/{name}", name)
    finder = ResourceFinder(tmp_path / "install/mine/share/mine/urdf/arm.urdf", (), {})
    hand = tmp_path / "install/hand/share/hand"
    assert finder.package("hand") == hand
    assert finder.package("mine") == tmp_path / "install/mine/share/mine"


def test_of_an_installed_file_ament_says_the_neighbours(tmp_path):
    under, over = tmp_path / "under", tmp_path / "over"
    package(under / "share/mine", "mine")
    package(under / "share/hand", "hand")
    package(over / "share/hand", "hand")
    finder = ResourceFinder(under / "share/mine/urdf/arm.urdf", (), ament(over, under))
    assert finder.package("hand") == over / "share/hand"


def test_a_linked_file_has_its_targets_package_too(tmp_path):
    """As `colcon build --symlink-install` leaves it."""
    mesh = package(tmp_path / "src/mine", "mine")
    installed = tmp_path / "install/share/mine"
    (installed / "urdf").mkdir(parents=True)
    (installed / "package.xml").symlink_to(tmp_path / "src/mine/package.xml")
    (installed / "urdf/arm.urdf").symlink_to(tmp_path / "src/mine/urdf/arm.urdf")
    finder = ResourceFinder(installed / "urdf/arm.urdf", (), {})
    assert finder.package("mine") == installed
    assert finder.find("package://mine/meshes/a.stl") == mesh
    assert finder.find("../meshes/a.stl") == mesh


def test_a_file_outside_any_package_has_neighbours_behind_the_folders_given(tmp_path):
    beside, given = package(tmp_path / "a/arm_description"), package(tmp_path / "b/arm_description")
    file = tmp_path / "a/arm.urdf"
    assert ResourceFinder(file, (), {}).find(URI) == beside
    assert ResourceFinder(file, [tmp_path / "b"], {}).find(URI) == given


def test_a_folder_that_is_only_called_so_comes_after_what_is_installed(tmp_path):
    (tmp_path / "home/hand").mkdir(parents=True)
    file = tmp_path / "home/arm.urdf"
    assert ResourceFinder(file, (), {}).package("hand") == tmp_path / "home/hand"
    package(tmp_path / "share/hand", "hand")
    assert ResourceFinder(file, (), ament(tmp_path)).package("hand") == tmp_path / "share/hand"


def test_the_code_of_a_python_package_is_not_the_package(tmp_path):
    package(tmp_path / "mine", "mine")
    (tmp_path / "mine/mine").mkdir()
    assert ResourceFinder(None, [tmp_path], {}).package("mine") == tmp_path / "mine"
    finder = ResourceFinder(tmp_path / "mine/urdf/arm.urdf", (), {})
    assert finder.package("mine") == tmp_path / "mine"


@pytest.mark.parametrize("folder", ["src", "install"])
def test_a_workspaces_folder_may_be_given(tmp_path, folder):
    inside = {"src": "src/repository/nested/hand_x", "install": "install/hand/share/hand"}[folder]
    mesh = package(tmp_path / inside, "hand")
    finder = ResourceFinder(None, [tmp_path / folder], {})
    assert finder.find("package://hand/meshes/a.stl") == mesh


def test_what_colcon_ignores_is_not_searched(tmp_path):
    package(tmp_path / "old/hand", "hand")
    (tmp_path / "old/COLCON_IGNORE").touch()
    with pytest.raises(ResourceNotFoundError):
        ResourceFinder(None, [tmp_path], {}).package("hand")


def test_relative_paths_start_beside_the_file(tmp_path):
    in_package = package(tmp_path / "mine", "mine")
    file = tmp_path / "mine/urdf/arm.urdf"
    finder = ResourceFinder(file, [tmp_path / "given"], {})
    assert finder.find("meshes/a.stl") == in_package
    given = tmp_path / "given/meshes/a.stl"
    beside = file.parent / "meshes/a.stl"
    for path in (given, beside):
        path.parent.mkdir(parents=True)
        path.touch()
    assert finder.find("meshes/a.stl") == beside


def test_a_manifest_is_read_once_for_all_files_of_a_package(tmp_path, monkeypatch):
    package(tmp_path / "mine")
    package(tmp_path / "mine", mesh="meshes/b.stl")
    finder = ResourceFinder(tmp_path / "mine/urdf/arm.urdf", (), {})
    finder.find(URI)
    read = []
    monkeypatch.setattr(package_search, "read_text", read.append)
    assert finder.find(URI.replace("a.stl", "b.stl")).name == "b.stl"
    assert not read
