"""`arm planning`: what a robot needs for motion planning."""

import argparse
from pathlib import Path

from arm_cli.arguments import Argument, positive_whole_number, verb
from arm_cli.check import expanded_urdf
from arm_cli.errors import ArmCliError, CommandUsageError
from arm_cli.output import complain, say_document, write_text

MIN_SAMPLES = 10_000


@verb(
    Argument("file", metavar="FILE", help="URDF or xacro file, or a package:// URI"),
    Argument("arguments", metavar="NAME:=VALUE", nargs="*", help="arguments of a xacro file"),
    Argument("--output", "-o", metavar="FILE", type=Path, help="file to write; default: print it"),
    Argument(
        "--samples",
        metavar="N",
        type=positive_whole_number,
        default=MIN_SAMPLES,
        help=f"random states that tell which links never touch (default and least: {MIN_SAMPLES})",
    ),
    Argument(
        "--package-path",
        metavar="DIR:DIR",
        default="",
        help="folders to search for package:// and $(find ...), before the installed packages",
    ),
    epilog="example: arm planning srdf my_robot.urdf -o my_robot.srdf",
)
def srdf(options: argparse.Namespace) -> None:
    """Print or write the SRDF."""
    if options.samples < MIN_SAMPLES:
        raise CommandUsageError(
            f"{options.samples} samples are too few to tell which links never touch; the least is "
            f"{MIN_SAMPLES}"
        )
    if options.output is not None and options.output.exists():
        raise CommandUsageError(f"{options.output} already exists; remove it, or choose another")
    text = _srdf_of(expanded_urdf(options.file, options.arguments, options.package_path), options)
    if options.output is None:
        say_document(text, end="")
        return
    write_text(options.output, text)


def _srdf_of(urdf: str, options: argparse.Namespace) -> str:
    """Return the SRDF of a robot; what collides at home is told on the standard error."""
    from arm_description.errors import DescriptionError
    from arm_description.resources import ResourceFinder
    from arm_description.urdf.parser import ignore_remark, parse_urdf
    from arm_planning.collision.mesh_pieces import MeshPieces
    from arm_planning.errors import PlanningError
    from arm_planning.robot.srdf import srdf_text
    from arm_planning.srdf_maker import make_srdf

    try:
        robot = parse_urdf(urdf, options.file, ignore_remark)
        meshes = MeshPieces(ResourceFinder.of_description(urdf))
        return srdf_text(make_srdf(robot, complain, options.samples, meshes=meshes))
    except (DescriptionError, PlanningError) as error:
        raise ArmCliError(str(error)) from error
