"""`arm launch ros_gz_sim gz_sim.launch.py gz_args:=shapes.sdf`: the shapes are there to be seen."""

import numpy as np
from sensor_msgs.msg import Image

CHANNELS = {"box": 0, "cylinder": 1, "sphere": 2}
"""The red, the green and the blue shape."""
FEWEST_PIXELS = 500


def pixels_of(image, strong: int) -> int:
    """Return how many pixels show one of red, green and blue and hardly the others."""
    channels = np.frombuffer(image.data, np.uint8).reshape(image.height, image.width, 3).astype(int)
    others = [channels[..., i] for i in range(3) if i != strong]
    return int((channels[..., strong] > np.maximum(*others) + 50).sum())


def test_the_camera_sees_box_cylinder_and_sphere(launch, client):
    launch("ros_gz_sim", "gz_sim.launch.py", "gz_args:=shapes.sdf").wait_until_ready()
    pictures = client.subscribe(Image, "/videocamera")
    image = pictures.wait_for(1)[-1]

    assert (image.width, image.height) == (640, 480)
    for shape, channel in CHANNELS.items():
        assert pixels_of(image, channel) > FEWEST_PIXELS, shape


def test_the_camera_looks_over_the_walls_of_the_house(launch, client):
    launch("ros_gz_sim", "gz_sim.launch.py", "gz_args:=house.world").wait_until_ready()
    image = client.subscribe(Image, "/videocamera").wait_for(1)[-1]
    pixels = np.frombuffer(image.data, np.uint8).reshape(image.height, image.width, 3).astype(int)
    saturation = pixels.max(axis=2) - pixels.min(axis=2)
    # Walls are grey; floors and furniture are not.
    assert (saturation > 25).mean() > 0.3
