#!/usr/bin/env bash
# av 18.1.0 (its libx264): the same images, encoded twice by one thread, may give different bytes.
#
# A good guess is that an encoder with one thread repeats itself, so that a dataset that is recorded
# again from the same seeds has the same files. libx264's macroblock tree, which all presets but
# ultrafast use, decides by memory that was not written before: with another filling of new memory by
# the C library, the video has other bytes, and is as good. In ordinary use one video of some 280
# differed. With mbtree=0 all are equal; videos of a robot are a seventh larger then.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'av==18.1.0' 'numpy==2.4.6'

cat >"$folder/encode.py" <<'PYTHON'
import hashlib
import io
import sys

import av
import numpy as np

y, x = np.mgrid[:240, :320]
written = io.BytesIO()
container = av.open(written, "w", format="mp4")
options = {"crf": "18", "preset": "veryfast", "g": "2", "threads": "1", "mbtree": sys.argv[1]}
stream = container.add_stream("libx264", rate=25, options=options)
stream.width, stream.height, stream.pix_fmt = 320, 240, "yuv420p"
for k in range(12):
    red = 128 + 100 * np.sin((x + 5 * k) / 17) * np.cos(y / 23)
    green = 128 + 90 * np.sin((y + 4 * k) / 13)
    image = np.stack([red, green, (3 * x + 2 * y + 7 * k) % 256], -1).astype(np.uint8)
    container.mux(stream.encode(av.VideoFrame.from_ndarray(image, format="rgb24")))
container.mux(stream.encode())
container.close()
print(hashlib.sha256(written.getvalue()).hexdigest()[:8])
PYTHON

"$folder/venv/bin/python" -c "import av; print('av', av.__version__, av.library_versions['libavcodec'])"
different() { # how many different videos three fillings of memory give, with this mbtree
  for filling in 0 1 85; do
    MALLOC_PERTURB_=$filling "$folder/venv/bin/python" "$folder/encode.py" "$1"
  done | sort -u | wc -l
}
with=$(different 1) without=$(different 0)
echo "of the same 12 images, with three fillings of memory:"
echo "mbtree=1: $with different videos; mbtree=0: $without"
[ "$with" -gt 1 ] && [ "$without" -eq 1 ] || { echo "the behaviour has changed"; exit 1; }
# Output seen:
# av 18.1.0 (62, 28, 102)
# of the same 12 images, with three fillings of memory:
# mbtree=1: 3 different videos; mbtree=0: 1
