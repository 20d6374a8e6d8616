#!/usr/bin/env bash
# rosbags-image 0.10.4: an image whose rows are padded comes out sheared, without an error.
#
# A sensor_msgs/Image says by `step` how many bytes a row has. Cameras that align rows, and drivers that cut
# a region out of a frame, send steps larger than the pixels need. A good guess is that message_to_cvimage()
# follows it, as cv_bridge does, or refuses it. It takes the bytes as if no row had padding: the padding
# becomes pixels, each row begins further to the right than the one before, and the last rows are lost. In a
# depth image a whole row can become 0. The byte order, is_bigendian, is followed, and so are images without
# padding.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'rosbags-image==0.10.4' 'rosbags==0.11.9' 'opencv-python-headless==5.0.0.93' 'numpy==2.4.6'

"$folder/venv/bin/python" - <<'PYTHON'
import sys
from importlib.metadata import version

import numpy as np
from rosbags.image import message_to_cvimage
from rosbags.typesys import Stores, get_typestore

TYPES = get_typestore(Stores.ROS2_JAZZY).types
GREY = np.array([[1, 2, 3], [4, 5, 6]], np.uint8)
DEPTH = np.array([[1000, 2000], [3000, 4000]], np.uint16)


def read(pixels: np.ndarray, encoding: str, padding: int = 0, big: bool = False) -> np.ndarray:
    """Return the pixels of a message that holds these, with some bytes after each row."""
    stored = pixels.astype(pixels.dtype.newbyteorder(">" if big else "<"))
    rows = stored.view(np.uint8).reshape(len(pixels), -1)
    rows = np.hstack([rows, np.zeros((len(rows), padding), np.uint8)])
    stamp = TYPES["builtin_interfaces/msg/Time"](0, 0)
    header = TYPES["std_msgs/msg/Header"](stamp, "camera")
    height, width = pixels.shape
    make = TYPES["sensor_msgs/msg/Image"]
    return message_to_cvimage(make(header, height, width, encoding, int(big), rows.shape[1], rows.ravel()))


print("rosbags-image", version("rosbags-image"))
found = {
    "mono8": (GREY, read(GREY, "mono8")),
    "mono8, a byte after each row": (GREY, read(GREY, "mono8", padding=1)),
    "16UC1": (DEPTH, read(DEPTH, "16UC1")),
    "16UC1, four bytes after each row": (DEPTH, read(DEPTH, "16UC1", padding=4)),
    "16UC1, big-endian": (DEPTH, read(DEPTH, "16UC1", big=True)),
}
for name, (sent, got) in found.items():
    print(f"{name}: {sent.tolist()} is read as {np.asarray(got).tolist()}")
right = [np.array_equal(sent, got) for sent, got in found.values()]
if right != [True, False, True, False, True]:
    sys.exit("the behaviour has changed")
PYTHON
# Output seen:
# rosbags-image 0.10.4
# mono8: [[1, 2, 3], [4, 5, 6]] is read as [[1, 2, 3], [4, 5, 6]]
# mono8, a byte after each row: [[1, 2, 3], [4, 5, 6]] is read as [[1, 2, 3], [0, 4, 5]]
# 16UC1: [[1000, 2000], [3000, 4000]] is read as [[1000, 2000], [3000, 4000]]
# 16UC1, four bytes after each row: [[1000, 2000], [3000, 4000]] is read as [[1000, 2000], [0, 0]]
# 16UC1, big-endian: [[1000, 2000], [3000, 4000]] is read as [[1000, 2000], [3000, 4000]]
