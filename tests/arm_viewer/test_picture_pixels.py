"""ROS images converted to RGB, and what their pixels say."""

import numpy as np
import pytest

from arm_viewer.errors import PictureError
from arm_viewer.picture_pixels import colours, depth_range, depth_scale, value_at
from arm_viewer.snapshot import Picture


def picture(pixels, encoding, padding=0, is_bigendian=False):
    height, width = pixels.shape[:2]
    rows = np.ascontiguousarray(pixels).view(np.uint8).reshape(height, -1)
    rows = np.pad(rows, ((0, 0), (0, padding)))
    return Picture(encoding, width, height, rows.shape[1], is_bigendian, rows.ravel())


PIXELS = np.arange(2 * 3 * 3, dtype=np.uint8).reshape(2, 3, 3)


def test_rgb_is_as_it_is_and_bgr_is_turned():
    assert np.array_equal(colours(picture(PIXELS, "rgb8")), PIXELS)
    assert np.array_equal(colours(picture(PIXELS, "bgr8")), PIXELS[:, :, ::-1])


def test_what_follows_a_row_is_passed_over():
    assert np.array_equal(colours(picture(PIXELS, "rgb8", padding=5)), PIXELS)


def test_an_alpha_channel_is_left_out():
    pixels = np.arange(2 * 3 * 4, dtype=np.uint8).reshape(2, 3, 4)
    assert np.array_equal(colours(picture(pixels, "rgba8")), pixels[:, :, :3])
    assert np.array_equal(colours(picture(pixels, "bgra8")), pixels[:, :, 2::-1])


def test_grey_has_three_equal_channels():
    grey = np.array([[0, 128, 255]], dtype=np.uint8)
    assert np.array_equal(colours(picture(grey, "mono8")), np.repeat(grey[:, :, None], 3, axis=2))
    deep = np.array([[0, 0x80FF, 0xFFFF]], dtype=">u2")
    assert np.array_equal(
        colours(picture(deep, "mono16", is_bigendian=True))[:, :, 0], [[0, 128, 255]]
    )


def test_near_is_red_far_is_blue_and_unknown_black():
    depth = np.array([[0.5, 3.0, np.nan, np.inf, -np.inf]], dtype=np.float32)
    near, far, *unknown = colours(picture(depth, "32FC1"))[0].astype(int)
    assert near[0] > near[2]
    assert far[2] > far[0]
    assert not np.any(unknown)
    assert not colours(picture(np.full((2, 2), np.nan, np.float32), "32FC1")).any()


def test_a_large_image_becomes_smaller():
    large = picture(np.zeros((800, 1000, 3), dtype=np.uint8), "rgb8")
    assert colours(large).shape == (800, 1000, 3)
    shape = colours(large, 480).shape
    assert shape[1] <= 480
    assert shape[0] / shape[1] == pytest.approx(0.8, abs=0.01)


@pytest.mark.parametrize(
    "broken",
    [
        Picture("yuv422", 2, 2, 4, False, np.zeros(8, np.uint8)),
        Picture("rgb8", 2, 2, 5, False, np.zeros(10, np.uint8)),
        Picture("rgb8", 2, 2, 6, False, np.zeros(11, np.uint8)),
        Picture("rgb8", 0, 2, 6, False, np.zeros(12, np.uint8)),
        Picture("rgb8", 2, 0, 6, False, np.zeros(0, np.uint8)),
    ],
)
def test_an_unsupported_image_is_reported(broken):
    with pytest.raises(PictureError):
        colours(broken)


def test_distances_as_far_apart_as_numbers_go_have_colours():
    farthest = np.finfo(np.float32).max
    shown = colours(picture(np.array([[1.0, farthest, -farthest]], dtype=np.float32), "32FC1"))
    assert shown[0, 0].any()
    assert not shown[0, 2].any()


DEPTH = np.array([[0.5, 3.25, np.nan, np.inf, -np.inf, 0.0]], dtype=np.float32)


def test_a_pixel_of_a_depth_image_is_a_distance_or_says_why_not():
    told = [value_at(picture(DEPTH, "32FC1"), column, 0) for column in range(6)]
    assert told == ["0.500 m", "3.250 m", "unknown", "too far", "too near", "unknown"]
    millimetres = picture(np.array([[0, 1234]], dtype=np.uint16), "16UC1")
    assert [value_at(millimetres, column, 0) for column in (0, 1)] == ["unknown", "1.234 m"]


def test_a_pixel_of_a_colour_image_has_its_colours():
    assert value_at(picture(PIXELS, "rgb8"), 1, 0) == "R 3 G 4 B 5"
    assert value_at(picture(PIXELS, "bgr8"), 1, 0) == "R 5 G 4 B 3"
    assert value_at(picture(np.array([[7]], dtype=np.uint8), "mono8"), 0, 0) == "grey 7"
    for place in ((-1, 0), (3, 0), (0, 2)):
        assert value_at(picture(PIXELS, "rgb8"), *place) == ""


def test_the_scale_of_a_depth_image_goes_from_its_nearest_to_its_farthest_point():
    assert depth_range(picture(DEPTH, "32FC1")) == (0.5, 3.25)
    assert depth_range(picture(np.array([[250, 1000]], dtype=np.uint16), "16UC1")) == (0.25, 1.0)
    assert depth_range(picture(DEPTH[:, 2:], "32FC1")) is None
    assert depth_range(picture(PIXELS, "rgb8")) is None
    near, *_, far = depth_scale()
    shown = colours(picture(DEPTH, "32FC1"))[0]
    assert (near, far) == tuple("rgb({} {} {})".format(*colour) for colour in shown[:2])
