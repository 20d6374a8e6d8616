"""A MuJoCo model of what can collide: links, attached bodies and objects in the world.

Each is a body of its own. Only the joints that vary are joints; the others are built in at their
positions. Pairs that may touch are left out, so that any contact is a collision.
"""

import copy
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations, product

import mujoco
import numpy as np
from numpy.typing import NDArray

from arm_description.urdf.robot import Capsule
from arm_node.names import describe_known
from arm_planning.collision.contact import BodyKind
from arm_planning.collision.geoms import CUBE, Geom, link_geoms, object_geoms, object_placement
from arm_planning.collision.mesh_pieces import MeshPieces
from arm_planning.collision.scene_difference import same_robot, same_shapes
from arm_planning.errors import InvalidLinkError, InvalidObjectError, MoveItErrorCode, PlanningError
from arm_planning.kinematic_tree import PositionMap, kinematic_tree, position_map
from arm_planning.robot.model import PlanningModel
from arm_planning.scene.objects import AttachedBody
from arm_planning.scene.scene import PlanningScene

Array = NDArray[np.float64]
FIRST_TRIANGLE = np.array([0, 1, 2], np.int32)

SEARCHED_CORNERS = 300
"""Pieces of meshes with at most this many corners are searched corner by corner. It takes as long
as MuJoCo's walk along their edges, which needs 0.2 to 3 ms for each piece and compilation."""
CCD_ITERATIONS = 100
CCD_TOLERANCE = 1e-6
"""With these distances are within 0.01 um, with 1e-5 within 7 um and hardly faster."""
MAX_NAMED_PAIRS = 500
"""MuJoCo looks at each named pair in each state, which takes some 20 ns; unnamed ones it searches
for among all bodies."""
MEMORY_BYTES = 1 << 23
"""Room for some thousands of contacts."""
MOST_GONE = 20
"""A specification is not taken over if more objects than these and those of the scene are gone."""
PAIR_BYTES = 4
"""What MuJoCo's sorting needs for each pair of bodies: 2 bytes were seen."""

SELF, ROBOT, WORLD = 1, 2, 4
"""Bits of MuJoCo's contype and conaffinity. A geom of the robot has SELF against other parts of the
robot and ROBOT against the world; a grown copy takes over the second."""
WHOLE = (SELF | ROBOT, SELF | WORLD)
SELF_ONLY = (SELF, SELF)
GROWN = (ROBOT, WORLD)
OF_WORLD = (WORLD, ROBOT)
AFFINITY_SHIFT = 3
"""A geom's group carries both bits through the compiler, which makes hulls for geoms with bits."""


@dataclass(frozen=True, slots=True)
class CollisionBody:
    """What a body of the MuJoCo model is.

    Attributes:
        name: name of the link or object.
        kind: what it is.
        moves: whether a variable joint moves it; all do that are part of a model without a group.
    """

    name: str
    kind: BodyKind
    moves: bool


@dataclass(frozen=True, slots=True)
class CompiledScene:
    """A model and the meaning of its bodies and coordinates.

    Attributes:
        model: the compiled model.
        bodies: by MuJoCo's id; None for the world's own body.
        links: MuJoCo's id of the body of each link.
        coordinates: MuJoCo's coordinates as a function of the joints that vary.
        scene: what was compiled, the octomap as one of its objects. It may have objects that are
            not in the scene that was asked for: in the model they touch nothing.
        spec: MuJoCo's specification; never changed once it is here.
        parts: what the specification was made of.
        assets: the meshes in it, by the id of their corners.
    """

    model: mujoco.MjModel
    bodies: tuple[CollisionBody | None, ...]
    links: dict[str, int]
    coordinates: PositionMap
    scene: PlanningScene
    spec: mujoco.MjSpec
    parts: "tuple[_Part, ...]"
    assets: dict[int, tuple[str, Array]]


@dataclass(slots=True)
class _Part:
    """A body while the specification is made.

    Attributes:
        carrier: the link that carries it.
        weld: the link that it never moves against, nearest to the root; "" in the world.
        geoms: its geoms with their bits.
    """

    name: str
    kind: BodyKind
    body: mujoco.MjsBody
    moves: bool
    carrier: str = ""
    weld: str = ""
    touch: frozenset[str] = frozenset()
    geoms: list[tuple[mujoco.MjsGeom, tuple[int, int]]] = field(default_factory=list)


class SceneCompiler:
    """Compiles a robot and its surroundings.

    Distances are exact as well, where there is a margin, not only contacts. MuJoCo's own function
    for two boxes is faster than that for other shapes, but its distances are wrong by centimetres;
    so the robot's boxes are made of corners. Those of the world are as well if the robot has a
    capsule: a capsule that goes right through a box, both ends outside, is no contact for MuJoCo.
    And each pair of the robot's own geoms has a margin of its own, if they are not too many.

    Args:
        model: the robot.
        scene: where everything is.
        varying: active joints that can move; all others stay at their positions in the scene.
        meshes: cuts meshes; keep it, because it remembers them.
        like: a compiled scene of the same robot with the same joints, if there is one. If only
            objects differ, what is the same is taken over: MuJoCo copies a specification or a
            model much faster than it makes them.
    """

    def __init__(
        self,
        model: PlanningModel,
        scene: PlanningScene,
        varying: Sequence[str],
        meshes: MeshPieces,
        like: CompiledScene | None = None,
    ) -> None:
        self._robot = model.robot
        self._varying = varying
        self._like = like
        self._scene = replace(scene, objects=scene.obstacles, octomap=None)
        self._meshes = meshes
        self._links: dict[str, _Part] = {}
        self._attached: list[_Part] = []
        self._objects: list[_Part] = []
        self._assets: dict[int, tuple[str, Array]] = {}
        self._boxes: dict[tuple[float, float, float], Array] = {}
        shapes = [shape.geometry for link in self._robot.links for shape in link.collisions]
        self._has_capsule = any(isinstance(shape, Capsule) for shape in shapes)

    def compile(self) -> CompiledScene:
        """Return the compiled scene.

        Raises:
            PlanningError: a mesh or a shape cannot be used, or a body is attached to a link that
                does not exist.
        """
        if self._like is not None and self._may_take_over(self._like):
            if self._scene.objects.keys() <= self._like.scene.objects.keys():
                return self._rearranged(self._like)
            self._take_over(self._like)
        else:
            self._begin()
            self._add_links()
            self._add_attached()
            self._leave_out_allowed_pairs()
        self._add_objects()
        return self._compiled()

    def _may_take_over(self, like: CompiledScene) -> bool:
        before, scene = like.scene, self._scene
        gone = len(before.objects.keys() - scene.objects.keys())
        return (
            gone <= max(MOST_GONE, len(scene.objects))
            and same_robot(before, scene, self._varying)
            and same_shapes(before.objects, scene.objects)
        )

    def _rearranged(self, like: CompiledScene) -> CompiledScene:
        """Return a compiled scene with its objects in other places, or without some of them."""
        model = copy.copy(like.model)
        for number, body in enumerate(like.bodies):
            if body is not None and body.kind is BodyKind.WORLD_OBJECT:
                thing = self._scene.objects.get(body.name)
                if thing is not None:
                    model.body_pos[number], model.body_quat[number] = object_placement(thing)
        self._set_bits(model, like.bodies)
        return replace(like, model=model)

    def _take_over(self, like: CompiledScene) -> None:
        """Begin with a compiled scene's specification."""
        self._spec, self._coordinates = like.spec.copy(), like.coordinates
        self._assets = dict(like.assets)
        for part in like.parts:
            own = replace(part, body=self._spec.body(part.body.name))
            if part.kind is BodyKind.ROBOT_LINK:
                self._links[part.name] = own
            elif part.kind is BodyKind.ROBOT_ATTACHED:
                self._attached.append(own)
            else:
                self._objects.append(own)
                thing = self._scene.objects.get(part.name)
                if thing is not None and thing is not like.scene.objects[part.name]:
                    own.body.pos, own.body.quat = object_placement(thing)

    def _begin(self) -> None:
        names = [joint.name for joint in self._robot.joints_in_tree_order if joint.type.is_scalar]
        positions = position_map(self._robot, names, self._varying, self._scene.positions)
        moving = (positions.matrix != 0.0).sum(axis=1) > 0
        built_in = {
            name: float(positions.constant[row])
            for row, name in enumerate(names)
            if not moving[row]
        }
        self._coordinates = PositionMap(positions.matrix[moving], positions.constant[moving])
        self._tree = kinematic_tree(self._robot, built_in=built_in)
        self._spec = self._tree.spec
        self._set_options()

    def _compiled(self) -> CompiledScene:
        parts = tuple(self._parts())
        self._spec.memory = MEMORY_BYTES + PAIR_BYTES * (len(parts) + 1) ** 2
        try:
            model = self._spec.compile()
        except ValueError as error:
            raise PlanningError(
                MoveItErrorCode.COLLISION_CHECKING_UNAVAILABLE,
                f"MuJoCo cannot use a shape of the robot or the scene: {error}",
            ) from error
        bodies: list[CollisionBody | None] = [None] * model.nbody
        for part in parts:
            bodies[part.body.id] = CollisionBody(part.name, part.kind, part.moves)
        self._set_bits(model, tuple(bodies))
        before = {} if self._like is None else self._like.scene.objects
        objects = {
            part.name: self._scene.objects.get(part.name) or before[part.name]
            for part in self._objects
        }
        return CompiledScene(
            model,
            tuple(bodies),
            {name: part.body.id for name, part in self._links.items()},
            self._coordinates,
            replace(self._scene, objects=objects),
            self._spec,
            parts,
            self._assets,
        )

    def _set_bits(self, model: mujoco.MjModel, bodies: tuple[CollisionBody | None, ...]) -> None:
        """Give geoms the bits that decide what they touch; objects that are gone touch nothing."""
        objects = self._scene.objects
        is_gone = np.array(
            [
                body is not None and body.kind is BodyKind.WORLD_OBJECT and body.name not in objects
                for body in bodies
            ]
        )
        group = np.where(is_gone[model.geom_bodyid], 0, model.geom_group)
        model.geom_contype[:] = group & (1 << AFFINITY_SHIFT) - 1
        model.geom_conaffinity[:] = group >> AFFINITY_SHIFT
        model.body_contype[:] = model.body_conaffinity[:] = 0
        np.bitwise_or.at(model.body_contype, model.geom_bodyid, model.geom_contype)
        np.bitwise_or.at(model.body_conaffinity, model.geom_bodyid, model.geom_conaffinity)

    def _set_options(self) -> None:
        option, compiler = self._spec.option, self._spec.compiler
        # Links next to each other are checked, too, unless they may touch.
        option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_FILTERPARENT)
        option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_MULTICCD)
        option.ccd_iterations, option.ccd_tolerance = CCD_ITERATIONS, CCD_TOLERANCE
        compiler.degree = False
        compiler.boundmass = compiler.boundinertia = 1.0

    def _parts(self) -> Iterator[_Part]:
        yield from self._links.values()
        yield from self._attached
        yield from self._objects

    def _add_links(self) -> None:
        weld = {self._robot.root: ""}
        for joint in self._robot.joints_in_tree_order:
            moves = joint.name in self._tree.joints
            weld[joint.child] = joint.child if moves else weld[joint.parent]
        for name, body in self._tree.bodies.items():
            body.name = f"link {name}"
            self._add_link(name, body, weld[name])

    def _add_link(self, name: str, body: mujoco.MjsBody, weld: str) -> None:
        part = _Part(name, BodyKind.ROBOT_LINK, body, bool(weld), carrier=name, weld=weld)
        self._links[name] = part
        scale = self._scene.scale.get(name, 1.0)
        padding_m = self._scene.padding.get(name, 0.0)
        for geom in link_geoms(self._robot.link(name), self._meshes):
            if scale == 1.0 and padding_m == 0.0:
                self._add_geom(part, geom, WHOLE)
            else:
                self._add_geom(part, geom, SELF_ONLY)
                self._add_geom(part, geom.grown(scale, padding_m), GROWN)

    def _add_attached(self) -> None:
        for attached in self._scene.attached.values():
            thing = attached.object
            link = self._link_of(attached)
            position, quaternion = object_placement(thing)
            body = link.body.add_body(name=f"attached {thing.id}", pos=position, quat=quaternion)
            part = _Part(
                thing.id,
                BodyKind.ROBOT_ATTACHED,
                body,
                link.moves,
                carrier=attached.link,
                touch=attached.touch_links,
                weld=link.weld,
            )
            self._attached.append(part)
            for geom in object_geoms(thing, self._meshes):
                if geom.type == mujoco.mjtGeom.mjGEOM_PLANE:
                    raise InvalidObjectError(
                        f"object '{thing.id}' has a plane, which cannot be attached to a link"
                    )
                self._add_geom(part, geom, WHOLE)

    def _link_of(self, attached: AttachedBody) -> _Part:
        if attached.link not in self._links:
            raise InvalidLinkError(
                f"object '{attached.object.id}' is attached to '{attached.link}': "
                f"no such link; {describe_known(attached.link, self._links, 'the robot has')}"
            )
        return self._links[attached.link]

    def _add_objects(self) -> None:
        """Add the objects that the specification does not have yet."""
        known = {part.name for part in self._objects}
        added: list[_Part] = []
        for thing in self._scene.objects.values():
            if thing.id in known:
                continue
            position, quaternion = object_placement(thing)
            body = self._spec.worldbody.add_body(
                name=f"object {thing.id}", pos=position, quat=quaternion
            )
            part = _Part(thing.id, BodyKind.WORLD_OBJECT, body, moves=False)
            added.append(part)
            for geom in object_geoms(thing, self._meshes):
                self._add_geom(part, geom, OF_WORLD)
        self._leave_out_allowed_objects(added)
        self._objects += added

    def _leave_out_allowed_objects(self, objects: list[_Part]) -> None:
        robot = [part for part in (*self._links.values(), *self._attached) if part.geoms]
        allowed = self._scene.allowed
        named = {name for pair in allowed.pairs for name in pair} | set(allowed.defaults)
        for thing in objects:
            for part in robot:
                # Of many objects most are nowhere named, and so may touch nothing.
                known = thing.name in named or part.name in allowed.defaults
                may = known and allowed.may_touch(thing.name, part.name)
                if may or thing.name in part.touch:
                    self._spec.add_exclude(bodyname1=thing.body.name, bodyname2=part.body.name)

    def _add_geom(self, part: _Part, geom: Geom, bits: tuple[int, int]) -> None:
        corners = geom.corners
        if geom.type == mujoco.mjtGeom.mjGEOM_BOX and (bits != OF_WORLD or self._has_capsule):
            corners = self._boxes.setdefault(geom.size, CUBE * geom.size)
        hull = int(corners is not None and len(corners) > SEARCHED_CORNERS)
        position, quaternion = geom.placement
        added = part.body.add_geom(
            type=geom.type if corners is None else mujoco.mjtGeom.mjGEOM_MESH,
            pos=position,
            quat=quaternion,
            size=geom.size,
            contype=hull,
            conaffinity=hull,
            mass=0.0,
        )
        if corners is not None:
            added.meshname = self._asset(corners)
        _set_group(added, bits)
        part.geoms.append((added, bits))

    def _asset(self, corners: Array) -> str:
        """Return the mesh of a piece, which several bodies may have."""
        if id(corners) not in self._assets:
            name = f"mesh {len(self._assets)}"
            self._spec.add_mesh(
                name=name,
                uservert=corners.ravel(),
                userface=FIRST_TRIANGLE,
                inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
            )
            # The corners are kept, so that no other array gets their id.
            self._assets[id(corners)] = (name, corners)
        return self._assets[id(corners)][0]

    def _leave_out_allowed_pairs(self) -> None:
        robot = [part for part in (*self._links.values(), *self._attached) if part.geoms]
        checked: list[tuple[_Part, _Part]] = []
        for first, second in combinations(robot, 2):
            if self._allowed(first, second):
                self._spec.add_exclude(bodyname1=first.body.name, bodyname2=second.body.name)
            elif first.weld != second.weld:
                checked.append((first, second))
        self._name_pairs(robot, checked)

    def _name_pairs(self, robot: list[_Part], checked: list[tuple[_Part, _Part]]) -> None:
        """Name the pairs of the robot's geoms, if they are few, so that each has its own margin."""
        inner = {id(part): [geom for geom, bits in part.geoms if bits[0] & SELF] for part in robot}
        if sum(len(inner[id(a)]) * len(inner[id(b)]) for a, b in checked) > MAX_NAMED_PAIRS:
            return
        for part in robot:
            for number, (geom, _) in enumerate(part.geoms):
                geom.name = f"{number} of {part.body.name}"
        for first, second in checked:
            for a, b in product(inner[id(first)], inner[id(second)]):
                self._spec.add_pair(geomname1=a.name, geomname2=b.name)

    def _allowed(self, first: _Part, second: _Part) -> bool:
        """Return whether two parts of the robot may touch; what is attached may touch its link."""
        rigid = BodyKind.ROBOT_ATTACHED in (first.kind, second.kind)
        return (
            (rigid and first.carrier == second.carrier)
            or second.name in first.touch
            or first.name in second.touch
            or self._scene.allowed.may_touch(first.name, second.name)
        )


def _set_group(geom: mujoco.MjsGeom, bits: tuple[int, int]) -> None:
    geom.group = bits[0] | bits[1] << AFFINITY_SHIFT
