"""What is found on 100 random tables of one to six things, from four views, by a depth camera.

A table is right if kind, centre (5 mm) and size (10 %) of every thing are. A thing beside whose
pixels a nearer thing is in the picture may be returned as seen in part instead, and one of which
less than a fifth is seen may be missed; nothing else may be returned as a whole thing. Gaps are
5 mm or more; the noise of a depth z is 2 mm z². Times are of one core's processor, where other
loads on the machine count less.

    OPENBLAS_NUM_THREADS=1 python benchmarks/seeing.py --tables 100
"""

import argparse
import time
from math import pi, radians

import cv2
import numpy as np
from harness import Row, machine, print_table

from arm_planning.perception import testing
from arm_planning.perception.table import find_things

VIEWS = {
    "45 degrees, 640x480": (testing.camera_at(radians(45)), 97),
    "the tutorial's camera, 424x240": (testing.tutorial_camera(), 95),
    "20 degrees, 640x480": (testing.camera_at(radians(20)), 93),
    "from above, 640x480": (testing.camera_at(pi / 2), 93),
}


def row(name: str, camera: testing.DepthCamera, target: int, tables: int, noise_m: float) -> Row:
    right, things, whole, returned = 0, 0, 0, 0
    times_ms: list[float] = []
    for seed in range(tables):
        random = np.random.default_rng(seed)
        table = testing.random_table(random, camera)
        sight = testing.look(camera, table)
        points = testing.noisy(sight.points, random, noise_m)
        start_s = time.process_time()
        seen = find_things(points, camera.pose).things
        times_ms.append(1e3 * (time.process_time() - start_s))
        faults = testing.faults(table, sight, seen)
        for fault in faults:
            print(f"{name}, table {seed}: {fault}")
        right += not faults
        things += len(table)
        whole += sum(sight.whole)
        returned += sum(not thing.partial for thing in seen)
    middle, slow = np.percentile(times_ms, (50, 95))
    return Row(
        name,
        f"{right} of {tables} tables right; {things} things, {whole} in whole sight, {returned} "
        f"returned as whole; {middle:.0f} ms (95 %: {slow:.0f})",
        f"{target} of 100; 50 ms",
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tables", type=int, default=100)
    parser.add_argument("--noise", type=float, default=0.002, help="of a depth at 1 m, in m")
    options = parser.parse_args()
    cv2.setNumThreads(1)
    rows = [row(name, *view, options.tables, options.noise) for name, view in VIEWS.items()]
    print_table(f"Seeing. {machine()}", rows)


if __name__ == "__main__":
    main()
