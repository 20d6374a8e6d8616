"""A thing to be put into a running world: read from URDF, SDF or MJCF, ready to be attached."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.errors import DescriptionError, ResourceNotFoundError, XmlError
from arm_description.names import listing
from arm_description.resources import folders_of, resolve_uri
from arm_description.robot import Pose, Robot
from arm_description.urdf import parse_urdf
from arm_description.xacro_expansion import expand_xacro_file
from arm_description.xml_document import parse_xml
from arm_gazebo.build_report import BuildReport, Finding
from arm_gazebo.errors import GazeboError, MeshError
from arm_gazebo.mesh.cache import MeshCache
from arm_gazebo.mesh.library import MeshLibrary
from arm_gazebo.model.element_names import name_elements
from arm_gazebo.robot.body_tree import WORLD_LINK, BodyTree, TreeOptions
from arm_gazebo.robot.collision_policy import leave_out_neighbours, leave_out_own_contacts
from arm_gazebo.robot.gazebo_tags import GazeboTags, parse_gazebo_tags
from arm_gazebo.robot.link_geometry import LinkGeometry
from arm_gazebo.robot.mimic_joints import add_equalities, followings
from arm_gazebo.sdf.body import WORLD_MASKS, add_model
from arm_gazebo.sdf.element import SdfElement
from arm_gazebo.sdf.model import read_model
from arm_gazebo.sdf.world import sdf_file_in
from arm_gazebo.world.mjcf_files import check_mjcf_files
from arm_gazebo.world.refusal import Refusal, RefusedError

FORMATS = ("urdf", "sdf", "mjcf")
TRIAL_STEPS = 5
LARGEST_CHARACTERS = 20_000_000
FILE_MISSING = "opening file"
"""What MuJoCo says of a file that an MJCF names and that it cannot read."""


@dataclass(frozen=True, slots=True)
class SpawnModel:
    """A thing that can be attached to a world.

    Attributes:
        spec: holds it; it is copied, never changed.
        root: the body that is attached, with all below it.
        format: one of FORMATS.
        findings: what of it was repaired or left out.
        origin: pose (4, 4) of the root body in the thing's frame, which is another where a URDF
            begins with a `world` link.
    """

    spec: mujoco.MjSpec
    root: str
    format: str
    findings: tuple[Finding, ...] = ()
    origin: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))


@dataclass(frozen=True, slots=True)
class ModelSource:
    """Where things to be spawned come from.

    Attributes:
        step_s: physics step of the world that they join.
        package_path: folders for package://, model:// and plain paths.
        mesh_cache: folder of the meshes that were read before, or None.
    """

    step_s: float
    package_path: tuple[Path, ...] = ()
    mesh_cache: Path | None = None

    def read(self, uri: str, text: str) -> SpawnModel:
        """Return the thing that a URI names or, where there is none, that a text describes.

        Raises:
            RefusedError: there is no such thing, or it cannot be simulated.
        """
        if not (uri.strip() or text.strip()):
            raise RefusedError(
                Refusal.NO_RESOURCE, "nothing to spawn: neither uri nor resource_string is given"
            )
        return self._read_file(uri.strip()) if uri.strip() else self._read_text(text, None)

    def _read_file(self, uri: str) -> SpawnModel:
        try:
            path = resolve_uri(uri, self.package_path)
        except ResourceNotFoundError as error:
            raise RefusedError(Refusal.NO_RESOURCE, str(error)) from error
        if path.is_dir():
            file = sdf_file_in(path)
            if file is None:
                raise RefusedError(Refusal.NO_RESOURCE, f"the folder {path} has no .sdf file")
            path = file
        try:
            if not path.is_file():
                raise RefusedError(Refusal.NO_RESOURCE, f"{path} is no file")
            if path.stat().st_size > LARGEST_CHARACTERS:
                raise _too_large(str(path))
            if path.suffix in (".xacro", ".urdf"):
                return self._read_text(expand_xacro_file(path, {}, self.package_path).text, path)
            return self._read_text(path.read_text(encoding="utf-8"), path)
        except DescriptionError as error:
            raise RefusedError(Refusal.UNREADABLE, str(error)) from error
        except (OSError, UnicodeDecodeError) as error:
            raise RefusedError(Refusal.UNREADABLE, f"cannot read {path}: {error}") from error

    def _read_text(self, text: str, path: Path | None) -> SpawnModel:
        if len(text) > LARGEST_CHARACTERS:
            raise _too_large("the resource string")
        source = "resource_string" if path is None else str(path)
        try:
            tag = str(parse_xml(text, source).tag)
        except XmlError as error:
            raise RefusedError(Refusal.UNREADABLE, str(error)) from error
        readers: dict[str, Callable[[str, Path | None, BuildReport], SpawnModel]] = {
            "robot": self._read_urdf,
            "sdf": self._read_sdf,
            "mujoco": self._read_mjcf,
        }
        if tag not in readers:
            raise RefusedError(
                Refusal.UNSUPPORTED_FORMAT,
                f"{source}: <{tag}> is none of <robot> (URDF), <sdf> and <mujoco> (MJCF)",
            )
        return _checked(source, lambda: readers[tag](text, path, BuildReport()))

    def _read_urdf(self, text: str, path: Path | None, report: BuildReport) -> SpawnModel:
        robot = parse_urdf(text, "resource_string" if path is None else str(path))
        tags = parse_gazebo_tags(text)
        report.add(*tags.findings)
        spec, meshes = self._empty(path)
        default = mujoco.MjSpec().default
        geometry = LinkGeometry(meshes, default, tags, WORLD_MASKS, True, report)
        free = robot.root != WORLD_LINK and not _is_static(text)
        bodies = BodyTree(
            spec, robot, geometry, TreeOptions(self.step_s, default, free, Pose()), report
        ).add()
        follow = followings(robot, report)
        add_equalities(spec, robot, follow, self.step_s, report)
        _leave_out_own_contacts(spec, bodies, tags, report)
        root = _only_body(spec, "URDF")
        return SpawnModel(spec, root, "urdf", report.findings, _origin(robot, root, bodies))

    def _read_sdf(self, text: str, path: Path | None, report: BuildReport) -> SpawnModel:
        root = SdfElement.parse(text, path or Path("resource_string"))
        model = root.child("model")
        if model is None:
            raise root.error("has no <model> to spawn; a <world> is for LoadWorld")
        read = read_model(model, model.name or "model")
        spec, meshes = self._empty(path)
        add_model(spec, meshes, read, Pose(), report, strict=True)
        report.add(*model.unread())
        return SpawnModel(spec, _only_body(spec, "SDF"), "sdf", report.findings)

    def _read_mjcf(self, text: str, path: Path | None, report: BuildReport) -> SpawnModel:
        check_mjcf_files(text, path)
        if path is None:
            spec = mujoco.MjSpec.from_string(text)
        else:
            spec = mujoco.MjSpec.from_file(str(path))
        for key in list(spec.keys):
            spec.delete(key)
        return SpawnModel(spec, _only_body(spec, "MJCF"), "mjcf", report.findings)

    def _empty(self, path: Path | None) -> tuple[mujoco.MjSpec, MeshLibrary]:
        spec = mujoco.MjSpec()
        spec.compiler.degree = False
        spec.option.timestep = self.step_s
        beside = () if path is None else folders_of(path)
        cache = None if self.mesh_cache is None else MeshCache(self.mesh_cache)
        return spec, MeshLibrary(spec, (*beside, *self.package_path), cache)


def _checked(source: str, read: Callable[[], SpawnModel]) -> SpawnModel:
    """Return what is read if it can be simulated by itself; raise a RefusedError otherwise."""
    try:
        model = read()
        _try(source, model.spec.copy().compile())
    except RefusedError:
        raise
    except MeshError as error:
        raise RefusedError(Refusal.MISSING_ASSETS, str(error)) from error
    except (GazeboError, DescriptionError, ValueError, mujoco.FatalError) as error:
        reason = " ".join(str(error).split())
        refusal = Refusal.MISSING_ASSETS if FILE_MISSING in reason else Refusal.UNREADABLE
        where = "" if source in reason else f"{source}: "
        raise RefusedError(refusal, f"{where}{reason}") from error
    return model


def _try(source: str, model: mujoco.MjModel) -> None:
    """Refuse what MuJoCo compiles but cannot simulate: numbers that are none, or beyond reason."""
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, TRIAL_STEPS)
    numbers = (model.body_mass, model.body_inertia, model.geom_rbound, data.xpos, data.geom_xpos)
    # MuJoCo starts over by itself where a number is no longer finite.
    started_over = data.time < (TRIAL_STEPS - 0.5) * model.opt.timestep
    if started_over or not all(np.isfinite(values).all() for values in numbers):
        raise RefusedError(
            Refusal.UNREADABLE, f"{source}: it has numbers with which it cannot be simulated"
        )


def _only_body(spec: mujoco.MjSpec, kind: str) -> str:
    """Return the one body right below the world, having named it."""
    name_elements(spec)
    bodies = spec.worldbody.bodies
    if len(bodies) != 1:
        there = listing([body.name for body in bodies]) if bodies else "none"
        raise RefusedError(
            Refusal.UNREADABLE,
            f"the {kind} needs one body right below the world, to be moved as one; it has {there}",
        )
    return str(bodies[0].name)


def _leave_out_own_contacts(
    spec: mujoco.MjSpec,
    bodies: Mapping[str, mujoco.MjsBody],
    tags: GazeboTags,
    report: BuildReport,
) -> None:
    """Let links touch each other only where the description says so, as those of a robot."""
    names = {link: body.name for link, body in bodies.items() if body.name != WORLD_LINK}
    touching = {
        name for link, name in names.items() if tags.self_collide or tags.link(link).self_collide
    }
    leave_out_own_contacts(spec, touching)
    if touching:
        model = spec.copy().compile()
        leave_out_neighbours(spec, model, model.qpos0, list(names.values()), report)


def _origin(robot: Robot, root: str, bodies: Mapping[str, mujoco.MjsBody]) -> NDArray[np.float64]:
    """Return where the first joint puts the root body; a root link is where the thing is."""
    first = next((j for j in robot.joints if bodies[j.child].name == root), None)
    return np.eye(4) if first is None else first.origin.matrix()


def _is_static(urdf: str) -> bool:
    return any(
        str(static.text).strip().lower() in ("true", "1")
        for static in parse_xml(urdf).findall("gazebo/static")
    )


def _too_large(source: str) -> RefusedError:
    return RefusedError(
        Refusal.UNREADABLE, f"{source} has more than {LARGEST_CHARACTERS} characters"
    )
