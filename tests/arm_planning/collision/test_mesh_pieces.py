from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from planning_models import model_of
from robots import joint, link, robot

from arm_description.urdf.robot import Mesh
from arm_node.rigid_transform import RigidTransform
from arm_planning.collision.mesh_pieces import MeshPieces, convex_pieces, hull, link_pieces
from arm_planning.collision.model import CollisionModel
from arm_planning.errors import PlanningError
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.shapes import TriangleMesh

CORNERS = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
FACES = np.array(
    [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5]),
        *([0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6]),
        *([0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
    ]
)
"""A cube; the last two triangles are its lid."""


def cube(*faces: np.ndarray) -> TriangleMesh:
    return TriangleMesh(CORNERS.copy(), np.array(faces if faces else FACES))


def probe(mesh: TriangleMesh) -> CollisionModel:
    """A ball of 50 mm on three sliders among the triangles of a mesh."""
    ball = "<collision><geometry><sphere radius='0.05'/></geometry></collision>"
    urdf = robot(
        *(link(name) for name in ("base", "a", "b")),
        link("ball", ball),
        joint("x", "base", "a", kind="prismatic", axis="1 0 0"),
        joint("y", "a", "b", kind="prismatic", axis="0 1 0"),
        joint("z", "b", "ball", kind="prismatic", axis="0 0 1"),
    )
    it = CollisionObject("mesh", RigidTransform(), (PlacedShape(mesh),))
    return CollisionModel(model_of(urdf), PlanningScene({}, {"mesh": it}))


def test_a_closed_convex_mesh_is_solid():
    model = probe(cube())
    assert not model.is_free(np.array([0.5, 0.5, 0.5]))
    assert not model.is_free(np.array([1.049, 0.5, 0.5]))
    assert model.is_free(np.array([1.051, 0.5, 0.5]))


def test_an_open_box_is_not_filled_up():
    model = probe(cube(*FACES[:-2]))
    assert model.is_free(np.array([0.5, 0.5, 0.5]))
    assert model.is_free(np.array([0.5, 0.5, 0.97]))
    for wall in ((0.04, 0.5, 0.5), (0.96, 0.5, 0.5), (0.5, 0.04, 0.5), (0.5, 0.5, 0.04)):
        assert not model.is_free(np.array(wall)), wall
    assert not model.is_free(np.array([1.04, 0.5, 0.5]))


def test_connected_parts_are_pieces_of_their_own():
    two = TriangleMesh(
        np.concatenate([CORNERS, CORNERS + np.array([2.0, 0.0, 0.0])]),
        np.concatenate([FACES, FACES + 8]),
    )
    assert len(convex_pieces(two)) == 2
    model = probe(two)
    assert model.is_free(np.array([1.5, 0.5, 0.5]))
    assert not model.is_free(np.array([0.5, 0.5, 0.5]))
    assert not model.is_free(np.array([2.5, 0.5, 0.5]))


def test_a_file_of_separate_triangles_is_joined():
    soup = TriangleMesh(CORNERS[FACES].reshape(-1, 3), np.arange(36).reshape(-1, 3))
    (piece,) = convex_pieces(soup)
    assert len(piece) == 8


def test_points_between_the_corners_of_a_convex_mesh_are_left_out():
    lid = np.array([[4, 6, 8], [6, 7, 8], [7, 5, 8], [5, 4, 8]])
    corners = np.concatenate([CORNERS, [[1.0, 0.5, 0.5]]])
    (piece,) = convex_pieces(TriangleMesh(corners, np.concatenate([FACES[:2], lid, FACES[4:]])))
    assert sorted(map(tuple, np.round(piece, 6))) == sorted(map(tuple, CORNERS))


def test_a_convex_mesh_of_corners_alone_is_its_own_hull():
    raised = np.concatenate([CORNERS, [[1.5, 0.5, 0.5]]])
    lid = np.array([[4, 6, 8], [6, 7, 8], [7, 5, 8], [5, 4, 8]])
    mesh = TriangleMesh(raised, np.concatenate([FACES[:2], lid, FACES[4:]]))
    (piece,) = convex_pieces(mesh)
    assert sorted(map(tuple, piece)) == sorted(map(tuple, raised))
    assert sorted(map(tuple, np.round(hull(raised), 6))) == sorted(map(tuple, raised))


def test_meshes_are_cut_by_several_threads():
    meshes, sizes = MeshPieces(), np.linspace(1.0, 2.0, 40)
    stones = [TriangleMesh(size * CORNERS, FACES) for size in sizes]
    with ThreadPoolExecutor(4) as threads:
        cut = list(threads.map(meshes.of_object, stones * 4))
    largest = [float(piece.max()) for (piece,) in cut]
    assert largest == pytest.approx([*sizes] * 4)


def test_a_notched_body_is_plates():
    """An L of two cubes: its hull would fill the notch."""
    outline = np.array([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], float)
    points = np.concatenate([np.column_stack([outline, np.full(6, z)]) for z in (0.0, 1.0)])
    cap = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]])
    sides = [[[i, (i + 1) % 6, i + 6], [(i + 1) % 6, (i + 1) % 6 + 6, i + 6]] for i in range(6)]
    mesh = TriangleMesh(points, np.concatenate([cap, cap + 6, np.array(sides).reshape(-1, 3)]))
    assert len(convex_pieces(mesh)) == len(mesh.triangles)
    model = probe(mesh)
    assert model.is_free(np.array([1.5, 1.5, 0.5]))
    assert model.is_free(np.array([1.06, 1.06, 0.5]))
    assert not model.is_free(np.array([1.04, 1.5, 0.5]))
    assert not model.is_free(np.array([1.5, 1.04, 0.5]))


def test_a_hull_has_the_outer_corners_only():
    rng = np.random.default_rng(0)
    inside = rng.uniform(0.1, 0.9, (50, 3))
    found = hull(np.concatenate([inside, CORNERS]))
    assert sorted(map(tuple, np.round(found, 6))) == sorted(map(tuple, CORNERS))


@pytest.mark.parametrize("size", [1.0, 1e-4])
@pytest.mark.parametrize("place", [(0.0, 0.5, 1.0), (0.0, 0.0, 0.0)])
def test_a_hull_does_not_care_which_points_come_first(place, size):
    # Corners in a line, or at one place, as files with a point for each corner of a triangle begin.
    beginning = np.array([[x, 0.0, 0.0] for x in place])
    corners = hull(size * np.concatenate([beginning, CORNERS]))
    assert np.ptp(corners, axis=0) == pytest.approx([size] * 3, rel=1e-4)
    assert len(corners) == len(CORNERS)


def test_a_flat_mesh_is_a_plate():
    square = TriangleMesh(CORNERS[:4].copy(), np.array([[0, 1, 3], [0, 3, 2]]))
    model = probe(square)
    assert not model.is_free(np.array([0.049, 0.5, 0.5]))
    assert not model.is_free(np.array([-0.049, 0.5, 0.5]))
    assert model.is_free(np.array([0.051, 0.5, 0.5]))


@pytest.mark.parametrize(
    ("vertices", "triangles", "message"),
    [
        (np.zeros((0, 3)), np.zeros((0, 3), int), "it has no triangles"),
        (CORNERS, np.zeros((0, 3), int), "it has no triangles"),
        (CORNERS, np.array([[0, 1, 8]]), "a corner that is not among its 8 vertices"),
        (CORNERS, np.array([[0, 1, -1]]), "a corner that is not among its 8 vertices"),
        (CORNERS * np.nan, FACES, "a vertex is not finite"),
        (CORNERS * 0.0, FACES, "all its vertices are at one place"),
        (CORNERS, np.array([[1, 1, 2]]), "all its triangles are without an area"),
        (CORNERS[:, :2], FACES, "do not have three numbers each"),
    ],
)
def test_broken_meshes_are_refused(vertices, triangles, message):
    with pytest.raises(PlanningError, match=f"the mesh cannot be used: .*{message}"):
        convex_pieces(TriangleMesh(vertices.copy(), triangles))


def test_a_surface_of_too_many_triangles_is_refused():
    count = 80
    grid = np.stack(np.meshgrid(np.arange(count), np.arange(count)), axis=-1).reshape(-1, 2)
    points = np.column_stack([grid, np.sin(grid[:, 0])])
    corner = (grid[:, 0] < count - 1) & (grid[:, 1] < count - 1)
    first = np.flatnonzero(corner)
    triangles = np.stack([first, first + 1, first + count], axis=1)
    with pytest.raises(PlanningError, match="6241 triangles in parts that are not convex"):
        convex_pieces(TriangleMesh(points, triangles))


def test_pieces_are_made_once():
    meshes = MeshPieces()
    assert meshes.of_object(cube()) is meshes.of_object(cube())


def side_by_side(count: int, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners and triangles of cubes in a row."""
    moved = [CORNERS + np.array([step * index, 0.0, 0.0]) for index in range(count)]
    return np.concatenate(moved), np.concatenate([FACES + 8 * index for index in range(count)])


def test_the_space_between_the_parts_of_a_links_mesh_is_free():
    first, second = link_pieces(*side_by_side(2, 3.0))
    assert (np.ptp(first, axis=0), np.ptp(second, axis=0)) == (
        pytest.approx((1.0, 1.0, 1.0)),
        pytest.approx((1.0, 1.0, 1.0)),
    )


def test_parts_of_a_links_mesh_are_found_if_each_triangle_has_its_own_corners():
    corners, triangles = side_by_side(2, 3.0)
    soup = np.arange(3 * len(triangles)).reshape(-1, 3)
    assert len(link_pieces(corners[triangles].reshape(-1, 3), soup)) == 2


def test_a_part_of_a_links_mesh_inside_of_another_is_no_piece():
    corners, triangles = side_by_side(2, 0.0)
    corners[8:] = 0.25 + corners[8:] / 2.0
    (piece,) = link_pieces(corners, triangles)
    assert np.ptp(piece, axis=0) == pytest.approx((1.0, 1.0, 1.0))


def test_many_parts_of_a_links_mesh_get_one_hull():
    (piece,) = link_pieces(*side_by_side(9, 3.0))
    assert np.ptp(piece, axis=0) == pytest.approx((25.0, 1.0, 1.0))


@given(st.lists(st.tuples(*[st.floats(-2.0, 2.0)] * 3), min_size=1, max_size=10))
def test_the_pieces_of_a_links_mesh_cover_it(places):
    corners = np.concatenate([CORNERS / 2.0 + np.array(place) for place in places])
    triangles = np.concatenate([FACES + 8 * index for index in range(len(places))])
    pieces = link_pieces(corners, triangles)
    low = np.concatenate(pieces).min(axis=0)
    assert low == pytest.approx(corners.min(axis=0), abs=2e-6)
    for corner in corners:
        # A corner of the mesh is in some piece: no direction separates it from all of that.
        assert any(np.linalg.norm(piece - corner, axis=1).min() < 2e-6 for piece in pieces) or any(
            ((piece.min(axis=0) <= corner + 2e-6) & (corner <= piece.max(axis=0) + 2e-6)).all()
            for piece in pieces
        )


def test_a_links_mesh_is_read_and_scaled(tmp_path):
    rows = [f"v {x} {y} {z}" for x, y, z in CORNERS]
    rows += ["f " + " ".join(str(corner + 1) for corner in face) for face in FACES]
    (tmp_path / "cube.obj").write_text("\n".join(rows))
    (piece,) = MeshPieces().of_file(Mesh(str(tmp_path / "cube.obj"), (1.0, 2.0, 0.5)))
    assert np.ptp(piece, axis=0) == pytest.approx((1.0, 2.0, 0.5), abs=1e-6)


def test_a_links_mesh_that_is_missing_is_named(tmp_path):
    shape = f"<collision><geometry><mesh filename='{tmp_path}/no.stl'/></geometry></collision>"
    with pytest.raises(PlanningError, match=r"link 'base': cannot use the mesh .*no\.stl"):
        CollisionModel(model_of(robot(link("base", shape))), PlanningScene({}))
