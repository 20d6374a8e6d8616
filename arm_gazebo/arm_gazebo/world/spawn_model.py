"""Read a model from URDF, SDF or MJCF, to be spawned into a running world."""

import os
from collections.abc import Callable, Mapping
from dataclasses import field, replace
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.errors import DescriptionError, ResourceNotFoundError, XmlError
from arm_description.resources import ResourceFinder, resolve_uri
from arm_description.urdf.description import RobotDescription
from arm_description.urdf.parser import parse_urdf
from arm_description.urdf.robot import Pose, Robot
from arm_description.urdf.xml_document import parse_xml
from arm_description.xacro.expansion import expand_xacro_file
from arm_gazebo.build_report import BuildReport, Finding
from arm_gazebo.errors import GazeboError, MeshError, Refusal, RequestError
from arm_gazebo.mesh.cache import MeshCache
from arm_gazebo.mesh.library import MeshLibrary
from arm_gazebo.mjcf.memory_limit import SPAWN_LIMIT, MemoryLimit
from arm_gazebo.mjcf.names import name_elements
from arm_gazebo.mjcf.size import check_mjcf_size
from arm_gazebo.model.world_file import report_margins
from arm_gazebo.robot.body_tree import WORLD_LINK, BodyTree, TreeOptions
from arm_gazebo.robot.collision_policy import exclude_neighbour_contacts, exclude_own_contacts
from arm_gazebo.robot.gazebo_tags import GazeboTags, parse_gazebo_tags
from arm_gazebo.robot.link_geometry import LinkGeometry
from arm_gazebo.robot.mimic_joints import add_equalities, mimic_rules
from arm_gazebo.sdf.body import WORLD_MASKS, add_model
from arm_gazebo.sdf.element import SdfElement, unread_findings
from arm_gazebo.sdf.model import read_model
from arm_gazebo.sdf.scope import SdfScope, sdf_file_in
from arm_gazebo.world.trial import MjcfTrial, can_be_simulated, check_mjcf_files
from arm_node.frozen import frozen
from arm_node.names import listing
from arm_node.user_file import UnusableFileError, read_text

FORMATS = ("urdf", "sdf", "mjcf")
MAX_CHARACTERS = 20_000_000
FILE_MISSING = "opening file"
"""Part of MuJoCo's message about an unreadable file that an MJCF names."""


@frozen
class SpawnModel:
    """A model that can be attached to a world.

    Attributes:
        spec: the specification; it is copied, never modified.
        root: the body to attach, with its subtree.
        format: one of FORMATS.
        findings: what was repaired or left out.
        origin: pose (4, 4) of the root body in the model's frame; it is not the identity if a URDF
            begins with a `world` link.
        uri: where it was read from, "" for a text.
        text: the text that it was read from, "" for a URI.
    """

    spec: mujoco.MjSpec
    root: str
    format: str
    findings: tuple[Finding, ...] = ()
    origin: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))
    uri: str = ""
    text: str = ""


@frozen
class ModelSource:
    """Reads models to spawn.

    Attributes:
        step_s: physics step of the world.
        package_path: folders for package://, model:// and plain paths.
        mesh_cache: folder of the mesh cache, or None.
        memory_limit: limit on the memory of an MJCF.
        trial: tries each MJCF before it is compiled in this process.
    """

    step_s: float
    package_path: tuple[Path, ...] = ()
    mesh_cache: Path | None = None
    memory_limit: MemoryLimit = SPAWN_LIMIT
    trial: MjcfTrial = field(default_factory=MjcfTrial)

    def read(self, uri: str, text: str) -> SpawnModel:
        """Return the model that a URI names, or without a URI the model that a text describes.

        Raises:
            RequestError: the model does not exist, or cannot be simulated.
        """
        if not (uri.strip() or text.strip()):
            raise RequestError(
                Refusal.NO_RESOURCE,
                "nothing to spawn: neither uri nor resource_string is given",
            )
        if uri.strip():
            return replace(self._read_file(uri.strip()), uri=uri.strip())
        return replace(self._read_text(text, None), text=text)

    def _read_file(self, uri: str) -> SpawnModel:
        try:
            path = resolve_uri(uri, self.package_path)
        except ResourceNotFoundError as error:
            raise RequestError(Refusal.NO_RESOURCE, str(error)) from error
        if os.path.isdir(path):
            file = sdf_file_in(path)
            if file is None:
                raise RequestError(Refusal.NO_RESOURCE, f"the folder {path} has no .sdf file")
            path = file
        try:
            if path.suffix in (".xacro", ".urdf"):
                return self._read_text(expand_xacro_file(path, {}, self.package_path).text, path)
            return self._read_text(read_text(path), path)
        except DescriptionError as error:
            raise RequestError(Refusal.UNREADABLE, str(error)) from error
        except UnusableFileError as error:
            raise RequestError(Refusal.NO_RESOURCE, f"cannot read {path}: {error}") from error
        except (OSError, ValueError) as error:
            raise RequestError(Refusal.UNREADABLE, f"cannot read {path}: {error}") from error

    def _read_text(self, text: str, path: Path | None) -> SpawnModel:
        if len(text) > MAX_CHARACTERS:
            raise _too_large("the resource string")
        source = "resource_string" if path is None else str(path)
        try:
            tag = str(parse_xml(text, source).tag)
        except XmlError as error:
            raise RequestError(Refusal.UNREADABLE, str(error)) from error
        readers: dict[str, Callable[[str, Path | None, BuildReport], SpawnModel]] = {
            "robot": self._read_urdf,
            "sdf": self._read_sdf,
            "mujoco": self._read_mjcf,
        }
        if tag not in readers:
            raise RequestError(
                Refusal.UNSUPPORTED_FORMAT,
                f"{source}: <{tag}> is not one of <robot> (URDF), <sdf> and <mujoco> (MJCF)",
            )
        return _checked(source, lambda: readers[tag](text, path, BuildReport()))

    def _read_urdf(self, text: str, path: Path | None, report: BuildReport) -> SpawnModel:
        description = RobotDescription(text, "resource_string" if path is None else str(path))
        robot, tags = parse_urdf(description), parse_gazebo_tags(description)
        report.add(*tags.findings)
        spec, meshes = self._empty(ResourceFinder.of_description(text, self.package_path))
        default = mujoco.MjSpec().default
        geometry = LinkGeometry(meshes, default, tags, WORLD_MASKS, True, report)
        free = robot.root != WORLD_LINK and not _is_static(description)
        options = TreeOptions(self.step_s, default, free, Pose(), tags.weightless)
        bodies = BodyTree(spec, robot, geometry, options, report).add()
        follow = mimic_rules(robot, report)
        add_equalities(spec, robot, follow, self.step_s, report)
        _leave_out_own_contacts(spec, bodies, tags, report)
        root = _only_body(spec, "URDF")
        return SpawnModel(spec, root, "urdf", report.findings, _origin(robot, root, bodies))

    def _read_sdf(self, text: str, path: Path | None, report: BuildReport) -> SpawnModel:
        root = SdfElement.of_text(text, path or Path("resource_string"))
        model = root.child("model")
        if model is None:
            raise root.error("has no <model> to spawn; a <world> is for LoadWorld")
        scope = SdfScope(model)
        spec, meshes = self._empty(ResourceFinder(path, self.package_path))
        for body in read_model(scope, model.name or "model"):
            add_model(spec, meshes, body, np.eye(4), report, strict=True)
        for include in scope.builtin_includes:
            report.leave_out(include.text("uri"), "it belongs to a world", include.line)
        report.add(*unread_findings([model, *scope.files]))
        return SpawnModel(spec, _only_body(spec, "SDF"), "sdf", report.findings)

    def _read_mjcf(self, text: str, path: Path | None, report: BuildReport) -> SpawnModel:
        check_mjcf_files(text, path)
        source = "resource_string" if path is None else str(path)
        check_mjcf_size(text, source, path, self.memory_limit)
        problem = self.trial.problem(text, path, self.memory_limit)
        if problem:
            raise ValueError(problem)
        if path is None:
            spec = mujoco.MjSpec.from_string(text)
        else:
            spec = mujoco.MjSpec.from_file(str(path))
        for key in list(spec.keys):
            spec.delete(key)
        report_margins(spec, "the model" if path is None else path.name, report)
        return SpawnModel(spec, _only_body(spec, "MJCF"), "mjcf", report.findings)

    def _empty(self, resources: ResourceFinder) -> tuple[mujoco.MjSpec, MeshLibrary]:
        spec = mujoco.MjSpec()
        spec.compiler.degree = False
        spec.option.timestep = self.step_s
        cache = None if self.mesh_cache is None else MeshCache(self.mesh_cache)
        return spec, MeshLibrary(spec, resources, cache)


def _checked(source: str, read: Callable[[], SpawnModel]) -> SpawnModel:
    """Return the model if it can be simulated alone; raise a RequestError otherwise."""
    try:
        model = read()
        if model.format != "mjcf":
            # An MJCF was already tried in a separate process.
            _try(source, model.spec.copy().compile())
    except RequestError:
        raise
    except MeshError as error:
        raise RequestError(Refusal.MISSING_ASSETS, str(error)) from error
    except (GazeboError, DescriptionError, OSError, ValueError, mujoco.FatalError) as error:
        reason = " ".join(str(error).split())
        refusal = Refusal.MISSING_ASSETS if FILE_MISSING in reason else Refusal.UNREADABLE
        where = "" if source in reason else f"{source}: "
        raise RequestError(refusal, f"{where}{reason}") from error
    return model


def _try(source: str, model: mujoco.MjModel) -> None:
    """Refuse a model that compiles but cannot be simulated: NaN, infinite or absurd numbers."""
    if not can_be_simulated(model):
        raise RequestError(Refusal.UNREADABLE, f"{source}: its numbers cannot be simulated")


def _only_body(spec: mujoco.MjSpec, kind: str) -> str:
    """Name all bodies and return the only top-level one."""
    name_elements(spec)
    bodies = spec.worldbody.bodies
    if len(bodies) != 1:
        there = listing([body.name for body in bodies]) if bodies else "none"
        raise RequestError(
            Refusal.UNREADABLE,
            f"the {kind} must have exactly one top-level body; it has {there}",
        )
    return str(bodies[0].name)


def _leave_out_own_contacts(
    spec: mujoco.MjSpec,
    bodies: Mapping[str, mujoco.MjsBody],
    tags: GazeboTags,
    report: BuildReport,
) -> None:
    """Let links collide with each other only if the description says so, as for a robot."""
    names = {link: body.name for link, body in bodies.items() if body.name != WORLD_LINK}
    touching = {
        name for link, name in names.items() if tags.self_collide or tags.link(link).self_collide
    }
    exclude_own_contacts(spec, touching)
    if touching:
        model = spec.copy().compile()
        exclude_neighbour_contacts(spec, model, model.qpos0, list(names.values()), report)


def _origin(robot: Robot, root: str, bodies: Mapping[str, mujoco.MjsBody]) -> NDArray[np.float64]:
    """Return the pose of the root body, which a joint to the `world` link may offset."""
    first = next((j for j in robot.joints if bodies[j.child].name == root), None)
    return np.eye(4) if first is None else first.origin.matrix()


def _is_static(description: RobotDescription) -> bool:
    flags = description.root.find("gazebo/static")
    return any(flag.content.lower() in ("true", "1") for flag in flags)


def _too_large(source: str) -> RequestError:
    return RequestError(Refusal.UNREADABLE, f"{source} has more than {MAX_CHARACTERS} characters")
