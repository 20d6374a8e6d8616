"""Pictures of the present state."""

from collections.abc import Iterator

import numpy as np
import pytest

from arm_description import expand_xacro, resolve_uri
from arm_sim import Simulation, UnknownNameError

pytestmark = pytest.mark.gl
NAME = "videocamera"
WALL = """<sdf version='1.9'><model name='wall'><static>true</static><link name='link'>
<visual name='v'><geometry><box><size>0.1 4 4</size></box></geometry></visual>
</link></model></sdf>"""


@pytest.fixture(scope="module", params=["auto", "raycast"])
def seen(request) -> Iterator[Simulation]:
    with Simulation(
        "arm", arguments={"camera": "side"}, world="objects", render_backend=request.param
    ) as simulation:
        yield simulation


def test_an_image_shows_the_present_state(seen):
    camera = seen.camera(NAME)
    before = camera.image()
    assert before.shape == (camera.height, camera.width, 3)
    assert before.dtype == np.uint8
    assert before.std() > 5.0
    seen["position_controller"].command([1.0, 0.5, 0.1, 0.5])
    seen.run(1.0)
    after = camera.image()
    assert (before != after).any()
    assert (after == camera.image()).all()


def test_depth_is_in_metres_and_infinite_beyond_the_range(seen):
    camera = seen.camera(NAME)
    depth = camera.depth()
    assert depth.shape == (camera.height, camera.width)
    finite = depth[np.isfinite(depth)]
    assert finite.size
    assert finite.min() > 0.0
    assert finite.max() <= 100.0


def test_a_depth_image_leaves_the_next_image_as_it_was(seen):
    camera = seen.camera(NAME)
    before = camera.image()
    camera.depth()
    assert (camera.image() == before).all()


def test_a_camera_is_found_by_its_name_and_its_topic(seen):
    assert seen.cameras == ("camera",)
    assert seen.camera("camera") is seen.camera("videocamera") is seen.camera("/videocamera")


def test_a_spawned_thing_is_seen(seen):
    camera = seen.camera(NAME)
    before = camera.image()
    name = seen.spawn(WALL, pose=(0.5, 0.0, 0.0), frame="camera_link")
    assert (camera.image() != before).mean() > 0.2
    seen.delete(name)
    assert (camera.image() == before).all()


def test_two_simulations_draw_side_by_side():
    with Simulation("arm") as one, Simulation("arm", world="objects") as other:
        camera = one.camera(NAME)
        before = camera.image()
        assert (other.camera(NAME).image() != before).any()
        assert (camera.image() == before).all()
        other.close()
        assert (camera.image() == before).all()


def test_the_intrinsic_matrix_has_its_centre_in_the_middle(seen):
    camera = seen.camera(NAME)
    assert camera.matrix[0, 2] == camera.width / 2
    assert camera.matrix[0, 0] == camera.matrix[1, 1] > 0


def test_rays_times_depth_are_the_points_of_a_plane(seen):
    camera = seen.camera(NAME)
    name = seen.spawn(WALL, pose=(0.5, 0.0, 0.0, 0.0, 0.4, 0.0), frame="camera_link")
    points = camera.rays() * camera.depth()[..., np.newaxis]
    seen.delete(name)
    assert points.shape == (camera.height, camera.width, 3)
    # The wall's front is 0.05 m before its middle; it is turned about the frame's y axis.
    normal = np.array([0.0, np.sin(0.4), np.cos(0.4)])
    distance = points @ normal
    seen_wall = np.abs(distance - np.median(distance)) < 1e-3
    assert seen_wall.mean() > 0.5
    assert np.median(distance) == pytest.approx(0.5 * np.cos(0.4) - 0.05, abs=1e-4)


def test_the_rays_are_those_of_the_matrix(seen):
    camera = seen.camera(NAME)
    pixel = camera.matrix @ camera.rays()[7, 11]
    np.testing.assert_allclose(pixel, [11.5, 7.5, 1.0], atol=1e-9)
    assert camera.distortion.tolist() == [0.0] * 5


LENS = """<lens><intrinsics><fx>300</fx><fy>310</fy><cx>150</cx><cy>125</cy></intrinsics></lens>
<distortion><k1>-0.1</k1><k2>0.02</k2></distortion>"""


@pytest.mark.parametrize("backend", ["auto", "raycast"])
def test_a_lens_of_the_description_is_the_library_s(backend, tmp_path):
    text = expand_xacro(resolve_uri("package://arm_description/urdf/arm.urdf.xacro"))
    urdf = tmp_path / "arm.urdf"
    urdf.write_text(text.replace("<image>", f"{LENS}<image>", 1))
    with Simulation(urdf, world="objects", render_backend=backend) as simulation:
        camera = simulation.camera(NAME)
        matrix, distortion = camera.matrix, camera.distortion
        depth, rays = camera.depth(), camera.rays()
        image = camera.image()
        state = simulation.save()
        simulation.run(0.2)
        simulation.restore(state)
        np.testing.assert_array_equal(camera.image(), image)
    np.testing.assert_array_equal(matrix, [[300, 0, 150], [0, 310, 125], [0, 0, 1]])
    assert distortion.tolist() == [-0.1, 0.02, 0.0, 0.0, 0.0]
    assert image.std() > 5.0
    floor = rays[-1] * depth[-1, :, np.newaxis]
    # The last row sees the floor, which is a plane: its points are on one line across.
    heights = floor @ np.linalg.lstsq(floor, np.ones(len(floor)), rcond=None)[0]
    np.testing.assert_allclose(heights, 1.0, atol=1e-3)


def test_an_unknown_camera_is_named_with_those_that_exist(seen, sim):
    with pytest.raises(UnknownNameError, match="no camera 'x'; the robot has camera"):
        seen.camera("x")
    with pytest.raises(UnknownNameError, match="no camera 'x'; the robot has none"):
        sim.camera("x")
