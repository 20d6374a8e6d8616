"""What a jump in a large recording costs, and the curve of one joint over all of it.

The bag has joint states and transforms of a robot, pictures as JPEG at 10 Hz, and one robot
description at its beginning. Small by default; `--minutes 60` makes 500 Hz for an hour, 1.2 GB, as
large as in issue reports of other players. A jump is until the page has
all that it shows of the moment, with six curves of the 20 s before it. Times are processor times.
"""

import argparse
import sys
import tempfile
import time
from pathlib import Path

import harness
import numpy as np

RATE_HZ = 500
PICTURE_EVERY = 50
JOINTS = 6
JPEG_BYTES = 20_000
PICTURES = 100
JUMPS = 40
CAMERA = "/camera/compressed"
CURVES = frozenset(f"/joint_states.position[joint{number}]" for number in range(JOINTS))


def write_bag(path: Path, minutes: float) -> None:
    """Write the bag with the suite's own recorder."""
    from geometry_msgs.msg import TransformStamped
    from rclpy.serialization import serialize_message
    from sensor_msgs.msg import CompressedImage, JointState
    from std_msgs.msg import String
    from tf2_msgs.msg import TFMessage

    from arm_cli.bag_format.topic import BagMessage, BagTopic, find_definition
    from arm_cli.bag_format.writer import BagSettings, BagWriter
    from arm_cli.interface_types import InterfaceIndex
    from arm_node.workarounds.message_template import MessageTemplate

    index, writer = InterfaceIndex(), BagWriter(path, BagSettings(compression="zstd"))
    names = [f"joint{number}" for number in range(JOINTS)]
    joints = MessageTemplate(
        JointState(name=names, **dict.fromkeys(("position", "velocity", "effort"), [0.1] * JOINTS))
    )
    steps = [TransformStamped(child_frame_id=f"link{number}") for number in range(JOINTS)]
    for number, step in enumerate(steps):
        step.header.frame_id = f"link{number - 1}" if number else "world"
    transforms = MessageTemplate(TFMessage(transforms=steps))
    pictures = [serialize_message(CompressedImage(format="jpeg", data=d)) for d in _jpegs()]
    description = serialize_message(String(data=_urdf()))
    types = {
        "/robot_description": "std_msgs/msg/String",
        "/joint_states": "sensor_msgs/msg/JointState",
        "/tf": "tf2_msgs/msg/TFMessage",
        CAMERA: "sensor_msgs/msg/CompressedImage",
    }
    for name, kind in types.items():
        writer.add_topic(BagTopic(name, kind), find_definition(index, kind))
    writer.write(BagMessage("/robot_description", 0, 0, description))
    position = joints.doubles("position")
    noise = np.random.default_rng(1)
    for tick in range(round(minutes * 60 * RATE_HZ)):
        now_ns = round(tick * 1e9 / RATE_HZ)
        position[:] = np.sin(tick / 1000.0 + np.arange(JOINTS)) + 1e-4 * noise.random(JOINTS)
        joints.set_stamps(now_ns)
        writer.write(BagMessage("/joint_states", now_ns, now_ns, joints.to_bytes()))
        if tick % 10 == 0:
            writer.write(BagMessage("/tf", now_ns, now_ns, transforms.to_bytes()))
        if tick % PICTURE_EVERY == 0:
            number = tick // PICTURE_EVERY
            writer.write(BagMessage(CAMERA, now_ns, now_ns, pictures[number % PICTURES]))
    writer.close()


def _jpegs() -> list[bytes]:
    """Return different pictures of 20 kB, as none of a camera is twice the same."""
    import cv2

    noise = np.random.default_rng(2).integers(0, 256, (PICTURES, 120, 200, 3), dtype=np.uint8)
    return [cv2.imencode(".jpg", picture)[1].tobytes()[:JPEG_BYTES] for picture in noise]


def _urdf() -> str:
    links = "".join(f"<link name='link{number}'/>" for number in range(JOINTS))
    joints = "".join(
        f"<joint name='joint{n}' type='continuous'><parent link='{parent}'/>"
        f"<child link='link{n}'/></joint>"
        for n in range(JOINTS)
        for parent in [f"link{n - 1}" if n else "world"]
    )
    return f"<robot name='r'><link name='world'/>{links}{joints}</robot>"


def measure(path: Path) -> list[tuple[str, float]]:
    """Return what was measured, each with its name."""
    from arm_viewer.recordings.curve import read_curve
    from arm_viewer.recordings.open_recording import Wanted
    from arm_viewer.recordings.recorded_bag import RecordedBag
    from arm_viewer.ros.recorded_state import RecordedState

    began_s = time.process_time()
    recording = RecordedBag(path)
    state = RecordedState(recording)
    opened_s = time.process_time() - began_s
    moments = np.random.default_rng(3).uniform(recording.start_ns, recording.end_ns, JUMPS)
    wanted = Wanted(frozenset({CAMERA}), CURVES)
    state.at(recording.start_ns, 0.0, 0.0, wanted)
    jumps_s = [_timed(lambda at=at: state.at(int(at), 0.0, 0.0, wanted)) for at in moments]
    played_s = [
        _timed(lambda at=tick: state.at(int(at * 1e9 / 30), 0.0, 1.0, wanted)) for tick in range(90)
    ]
    began_s = time.process_time()
    numbers = state.numbers()
    places_s = time.process_time() - began_s
    place = numbers["/joint_states", "position[joint0]"]
    began_s = time.process_time()
    curve = read_curve(recording, "/joint_states", place)
    curve_s = time.process_time() - began_s
    if curve.skipped or not np.isfinite(curve.low).all():
        sys.exit("the curve is not whole")
    return [
        ("open", opened_s),
        ("jump, median", float(np.median(jumps_s))),
        ("jump, largest", max(jumps_s)),
        ("next picture while playing, median", float(np.median(played_s))),
        ("find the numbers of all topics", places_s),
        ("curve of the whole recording", curve_s),
    ]


def _timed(act) -> float:
    began_s = time.process_time()
    act()
    return time.process_time() - began_s


def main() -> None:
    """Measure in a bag that is made for it, or in one that was kept."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=1.0, help="length of the bag (default 1)")
    parser.add_argument("--bag", type=Path, help="make the bag here and keep it, or use it again")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bag = options.bag or Path(folder, "bag")
        if not bag.exists():
            write_bag(bag, options.minutes)
        size = sum(file.stat().st_size for file in bag.iterdir())
        rows = [harness.Row(name, f"{1e3 * seconds:.1f} ms") for name, seconds in measure(bag)]
        harness.print_table(f"A recording of {size / 1e6:.0f} MB", rows)


if __name__ == "__main__":
    main()
