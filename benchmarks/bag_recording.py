"""What recording costs: per message in the writer, and of a whole robot's topics over ROS.

The robot is a process that publishes 500 Hz joint states, 500 Hz transforms and 30 Hz pictures of
640x480 and counts them; `arm bag record` runs beside it. Pictures are noise on a plain ground, so
that compressing them is some work.
"""

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import harness
import numpy as np
import psutil

RATE_HZ = 500
PICTURE_EVERY = RATE_HZ / 30
WIDTH, HEIGHT = 640, 480
TOPICS = ("/joint_states", "/tf", "/videocamera")


def messages() -> tuple:
    """Return a joint state, a transform message of 5 frames, and a picture."""
    from geometry_msgs.msg import TransformStamped
    from sensor_msgs.msg import Image, JointState
    from tf2_msgs.msg import TFMessage

    joints = JointState(name=[f"j{n}" for n in range(4)])
    joints.position = joints.velocity = joints.effort = [0.1, 0.2, 0.3, 0.4]
    transforms = TFMessage(transforms=[TransformStamped() for _ in range(5)])
    picture = Image(width=WIDTH, height=HEIGHT, encoding="rgb8", step=3 * WIDTH)
    noise = np.random.default_rng(1).integers(100, 108, WIDTH * HEIGHT * 3, dtype=np.uint8)
    picture.data.frombytes(noise.tobytes())
    return joints, transforms, picture


def publish(seconds: float) -> None:
    """Be the robot: publish once somebody listens to everything; print how many of each."""
    import rclpy

    rclpy.init()
    node = rclpy.create_node("robot")
    # Deep enough for the bursts after a stall of this process: they are not the recorder's affair.
    publishers = [
        (node.create_publisher(type(message), topic, 100), message)
        for topic, message in zip(TOPICS, messages(), strict=True)
    ]
    while not all(publisher.get_subscription_count() for publisher, _ in publishers):
        time.sleep(0.02)
    time.sleep(0.5)
    counts = dict.fromkeys(TOPICS, 0)
    started = time.monotonic()
    for tick in range(round(seconds * RATE_HZ)):
        time.sleep(max(0.0, started + tick / RATE_HZ - time.monotonic()))
        due = (True, True, tick % PICTURE_EVERY < 1)
        for topic, (publisher, message), now in zip(TOPICS, publishers, due, strict=True):
            if now:
                publisher.publish(message)
                counts[topic] += 1
    print(json.dumps({"counts": counts, "seconds": time.monotonic() - started}), flush=True)
    sys.stdin.read()
    rclpy.shutdown()


def record(seconds: float, compression: str) -> harness.Row:
    """Record the robot; compare what is in the bag with what was published."""
    from arm_gazebo.camera.process import camera_environment

    with harness.fresh_domain(), tempfile.TemporaryDirectory() as folder:
        environment = harness.client_environment()
        # As a camera process of the suite: with the default shared memory of 512 KiB its own
        # pictures overwrite what it sends beside them.
        environment = camera_environment(environment, 3 * WIDTH * HEIGHT)
        bag = Path(folder) / "bag"
        arm = [sys.executable, "-m", "arm_cli", "bag"]
        recorder = subprocess.Popen(
            [*arm, "record", *TOPICS, "-o", str(bag), "--compression", compression],
            env=harness.client_environment(),
            stderr=subprocess.PIPE,
            text=True,
        )
        robot = subprocess.Popen(
            [sys.executable, __file__, "--publish", str(seconds)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=environment,
        )
        time.sleep(seconds / 3)
        percent = harness.cpu_percent(psutil.Process(recorder.pid), seconds / 2)
        assert robot.stdout is not None
        published = json.loads(robot.stdout.readline())
        time.sleep(1.0)
        recorder.send_signal(signal.SIGINT)
        said = recorder.communicate()[1]
        robot.communicate("")
        info = json.loads(subprocess.check_output([*arm, "info", "--json", str(bag)], text=True))
    recorded = {topic["name"]: topic["count"] for topic in info["topics"]}
    missing = {t: n - recorded.get(t, 0) for t, n in published["counts"].items()}
    total = sum(published["counts"].values())
    dropped = ", ".join(f"{n} of {t}" for t, n in missing.items() if n) or "none"
    admitted = "No message was dropped" not in said
    return harness.Row(
        f"{total} messages in {published['seconds']:.0f} s, {compression}: missing in the bag",
        f"{dropped}{' (said)' if admitted else ''}; {percent:.0f} % of a core, "
        f"{info['size_bytes'] / 1e6 / published['seconds']:.1f} MB/s",
        "none, or said",
    )


def cost(name: str, message: object, count: int, compression: str) -> harness.Row:
    """Measure the writer's processor time for a message of a kind."""
    from rclpy.serialization import serialize_message

    from arm_cli.bag_format.topic import BagMessage, BagTopic, TypeDefinition
    from arm_cli.bag_format.writer import BagSettings, BagWriter

    data = serialize_message(message)
    with tempfile.TemporaryDirectory() as folder:
        writer = BagWriter(Path(folder) / "bag", BagSettings(compression=compression))
        writer.add_topic(BagTopic("/x", "x/msg/X"), TypeDefinition("x/msg/X", b""))
        started = time.process_time()
        for number in range(count):
            writer.write(BagMessage("/x", number, number, data))
        writer.close()
        taken = time.process_time() - started
    return harness.Row(
        f"{name} ({len(data)} bytes), {compression}: writer's processor time a message",
        f"{taken / count * 1e6:.0f} µs",
    )


def main() -> None:
    """Measure the costs and one recording for each compression."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--publish", type=float, metavar="SECONDS", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.publish is not None:
        publish(arguments.publish)
        return
    os.environ.setdefault("ROS_LOG_DIR", tempfile.gettempdir())
    joints, _, picture = messages()
    rows = [
        row
        for compression in ("none", "zstd")
        for row in (
            cost("joint state", joints, 20_000, compression),
            cost("picture 640x480", picture, 100, compression),
            record(arguments.seconds, compression),
        )
    ]
    harness.print_table("Recording: arm bag record", rows)


if __name__ == "__main__":
    main()
