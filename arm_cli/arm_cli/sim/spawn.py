"""`arm sim spawn`: put a thing into a running simulation."""

import argparse
from pathlib import Path

from arm_cli.sim.simulation import add_namespace_argument, ask_simulation


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument(
        "file", help="URDF, xacro, SDF or MJCF: a path or a URI such as model://can"
    )
    parser.add_argument("--name", default="", help="of the entity; by default that of its body")
    parser.add_argument(
        "--pose",
        nargs=6,
        type=float,
        default=[0.0] * 6,
        metavar=("X", "Y", "Z", "ROLL", "PITCH", "YAW"),
        help="in m and rad (default: the origin)",
    )
    parser.add_argument(
        "--frame", default="", help="of the pose: an entity or a link (default: the world)"
    )
    add_namespace_argument(parser)


def run(options: argparse.Namespace) -> None:
    """Spawn the thing and print its name.

    Raises:
        RefusedError: it cannot be spawned.
    """
    with ask_simulation(options) as simulation:
        from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
        from simulation_interfaces.msg import Resource

        from arm_description.transforms import quaternion_from_rpy

        x, y, z, *rpy = options.pose
        qx, qy, qz, qw = quaternion_from_rpy(rpy).tolist()
        pose = PoseStamped(
            pose=Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw))
        )
        pose.header.frame_id = options.frame
        # The simulation runs in a folder of its own.
        uri = options.file if "://" in options.file else str(Path(options.file).absolute())
        answer = simulation.ask(
            "SpawnEntity",
            "spawn_entity",
            name=options.name,
            allow_renaming=not options.name,
            entity_resource=Resource(uri=uri),
            initial_pose=pose,
        )
    print(answer.entity_name)
