"""Rate at which a default subscriber in another process gets pictures, and what they cost.

The simulation here is the arm in the objects world, stepped at 100 Hz in a process of its own,
with the camera process below it: what `arm launch` runs, without the controllers.
"""

import argparse
import dataclasses
import os
import subprocess
import sys
import threading
import time

import harness
import numpy as np
import psutil

TICK_S = 0.01
SIZES = ((320, 240, 0.0), (640, 480, 0.0), (800, 800, 0.0), (800, 800, 0.007))


def simulate(width: int, height: int, noise: float, backend: str) -> None:
    """Be the simulation until the standard input ends; print the camera process's id."""
    import mujoco

    from arm_control.hardware.info import parse_hardware_info
    from arm_description.resources import resolve_uri
    from arm_description.urdf.parser import parse_urdf
    from arm_description.xacro.expansion import expand_xacro
    from arm_gazebo.camera.feed import CameraFeed
    from arm_gazebo.model.builder import build_model
    from arm_gazebo.robot.part import BuildOptions
    from arm_gazebo.sensors.camera_reader import parse_cameras

    xacro = resolve_uri("package://arm_description/urdf/arm.urdf.xacro")
    urdf = expand_xacro(xacro, {"camera": "side"})
    cameras = [
        dataclasses.replace(camera, width=width, height=height, noise_stddev=noise)
        for camera in parse_cameras(urdf)
    ]
    built = build_model(
        parse_urdf(urdf), parse_hardware_info(urdf), cameras, "objects", BuildOptions()
    )
    data = mujoco.MjData(built.model)
    data.qpos[:] = built.qpos
    feed = CameraFeed(cameras, render_backend=backend)
    feed.start(built.model)
    (child,) = psutil.Process().children()
    print(child.pid, flush=True)
    ended = threading.Event()
    threading.Thread(target=lambda: (sys.stdin.read(), ended.set()), daemon=True).start()
    steps = round(TICK_S / built.model.opt.timestep)
    due = time.monotonic()
    while not ended.is_set():
        mujoco.mj_step(built.model, data, steps)
        feed.publish_due(data.time, data)
        due += TICK_S
        time.sleep(max(0.0, due - time.monotonic()))
    feed.close()


def measure(width: int, height: int, noise: float, backend: str, seconds: float) -> harness.Row:
    """Measure one size with one backend: best-effort and reliable subscriber, one by one."""
    what = f"{width}x{height}{' with noise' if noise else ''}, {backend}"
    rates, gaps = [], []
    with harness.fresh_domain():
        command = [__file__, "--simulate", str(width), str(height), str(noise), backend]
        simulation = subprocess.Popen(
            [sys.executable, *command],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={"AMENT_PREFIX_PATH": sys.prefix, **os.environ},
        )
        assert simulation.stdout is not None
        camera = psutil.Process(int(simulation.stdout.readline()))
        for quality in (["--best-effort"], []):
            client = harness.Client(
                *("record", "--topic", "/videocamera", "--seconds", str(seconds), *quality)
            )
            time.sleep(seconds / 2)
            percent = harness.cpu_percent(camera, seconds / 2)
            arrivals_s = np.array(client.answer()["arrivals_s"])
            client.stop()
            rates.append((len(arrivals_s) - 1) / (arrivals_s[-1] - arrivals_s[0]))
            gaps.append(np.diff(arrivals_s).max() * 1e3)
        memory = camera.memory_info().rss / 1e6
        simulation.communicate("")
    return harness.Row(
        what,
        f"{rates[0]:.2f} / {rates[1]:.2f} Hz, longest gap {gaps[0]:.0f} / {gaps[1]:.0f} ms, "
        f"{percent:.0f} % of a core, {memory:.0f} MB",
        target(width, backend, noise),
    )


def target(width: int, backend: str, noise: float) -> str:
    """Return what is asked for."""
    if backend == "raycast" or noise:
        return ""
    return "29.5 Hz, under 30 % of a core" if width == 320 else "29.5 Hz"


def main() -> None:
    """Measure every size with OpenGL and by casting rays."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--simulate", nargs=4, metavar=("WIDTH", "HEIGHT", "NOISE", "BACKEND"))
    arguments = parser.parse_args()
    if arguments.simulate:
        width, height, noise, backend = arguments.simulate
        simulate(int(width), int(height), float(noise), backend)
        return
    rows = [
        measure(*size, backend, arguments.seconds)
        for backend in ("auto", "raycast")
        for size in SIZES
    ]
    title = "Camera: best-effort / reliable default subscriber in another process"
    harness.print_table(f"{title} ({harness.machine()})", rows)


if __name__ == "__main__":
    main()
