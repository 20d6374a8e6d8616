"""Reads and writes objects of a scene as MoveIt's .scene files.

The first line is the scene's name. "* ID" starts an object: its pose, the number of its shapes, for
each shape its kind, its sizes, its pose and a colour, then the number of its subframes, for each
its name and its pose. A pose is x y z and x y z w. "." ends the file. Files from before ROS Noetic
have no pose of the object and no subframes.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import InvalidObjectError, PlanningError
from arm_planning.scene.frames import LinkPoses
from arm_planning.scene.object_changes import ObjectChange, Operation, change_object, explicit_pose
from arm_planning.scene.objects import CollisionObject, PlacedShape
from arm_planning.scene.scene import PlanningScene, Rgba
from arm_planning.scene.shapes import Cone, Plane, Shape, TriangleMesh

OBJECT, END = "*", "."
NO_COLOR = (0.0, 0.0, 0.0, 0.0)
KINDS = ("sphere", "box", "cylinder", "cone", "plane", "mesh")


def scene_text(scene: PlanningScene) -> str:
    """Return the objects of the world as a .scene file; what is attached is left out.

    Raises:
        PlanningError: INVALID_OBJECT_NAME: the file cannot hold the name of a subframe or object.
    """
    lines = [scene.name.replace("\n", " ")]
    for each in scene.objects.values():
        lines += _object_lines(each, scene.colors.get(each.id, NO_COLOR))
    return "\n".join([*lines, END, ""])


def with_scene_file(
    scene: PlanningScene, links: LinkPoses, text: str, source: str
) -> PlanningScene:
    """Return a scene with the objects and the name of a .scene file; objects of a name give way.

    Args:
        scene: the scene.
        links: the poses of its links.
        text: the file.
        source: its name in messages.

    Raises:
        PlanningError: the file is not such a file, or an object is unusable; the message names the
            line. None of the file's objects are in the scene then.
    """
    words = _Words(text, source)
    named = replace(scene, name=words.line())
    try:
        return _with_objects(named, links, words)
    except PlanningError as error:
        raise PlanningError(error.code, f"{words.place}: {error}") from error


def _object_lines(each: CollisionObject, color: Rgba) -> Iterator[str]:
    if each.id != each.id.strip() or "\n" in each.id:
        raise InvalidObjectError(
            f"a .scene file cannot hold the name {each.id!r}; rename the object"
        )
    yield f"{OBJECT} {each.id}"
    yield from _pose_lines(each.pose)
    yield str(len(each.shapes))
    for placed in each.shapes:
        yield from _shape_lines(placed.shape)
        yield from _pose_lines(placed.pose)
        yield _row(color)
    yield str(len(each.subframes))
    for name, pose in each.subframes.items():
        if name.split() != [name]:
            raise InvalidObjectError(
                f"a .scene file cannot hold the name {name!r} of a subframe of object '{each.id}', "
                "which has blanks; rename it"
            )
        yield name
        yield from _pose_lines(pose)


def _pose_lines(pose: RigidTransform) -> Iterator[str]:
    yield _row(pose.position)
    yield _row(pose.rotation)


def _shape_lines(shape: Shape) -> Iterator[str]:
    match shape:
        case Sphere(radius):
            yield from ("sphere", _row((radius,)))
        case Box(size):
            yield from ("box", _row(size))
        case Cylinder(radius, length):
            yield from ("cylinder", _row((radius, length)))
        case Cone(radius, height):
            yield from ("cone", _row((radius, height)))
        case Plane(a, b, c, d):
            yield from ("plane", _row((a, b, c, d)))
        case TriangleMesh(vertices, triangles):
            yield from ("mesh", f"{len(vertices)} {len(triangles)}")
            yield from map(_row, vertices.tolist())
            yield from (" ".join(map(str, corners)) for corners in triangles.tolist())


def _row(numbers: Sequence[float]) -> str:
    return " ".join(repr(float(number)) for number in numbers)


class _Words:
    """The words of a file, one after another, and where each stands."""

    def __init__(self, text: str, source: str) -> None:
        self._lines = [line.split() for line in text.split("\n")]
        self._source = source
        self._line = 0
        self._word = 0

    @property
    def place(self) -> str:
        """Where the last word stands."""
        return f"{self._source}, line {max(self._line, 1)}"

    def line(self) -> str:
        """Return the rest of the line, without surrounding blanks."""
        if self._word == 0 or self._line == 0:
            self._line += 1
        rest = self._lines[self._line - 1][self._word :] if self._line <= len(self._lines) else []
        self._word = len(rest) + self._word
        return " ".join(rest)

    def word(self, wanted: str) -> str:
        while self._line == 0 or self._word >= len(self._lines[self._line - 1]):
            if self._line >= len(self._lines):
                raise InvalidObjectError(f"the file ends where {wanted} should be")
            self._line, self._word = self._line + 1, 0
        self._word += 1
        return self._lines[self._line - 1][self._word - 1]

    def next_line_has_several(self) -> bool:
        """Return whether the next line that is not empty has more than one word."""
        following = (words for words in self._lines[self._line :] if words)
        return len(next(following, ())) > 1

    def number(self, wanted: str) -> float:
        word = self.word(wanted)
        try:
            value = float(word)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise InvalidObjectError(f"'{word}' is not {wanted}")
        return value

    def numbers(self, count: int, wanted: str) -> list[float]:
        return [self.number(wanted) for _ in range(count)]

    def count(self, wanted: str) -> int:
        """Return a number of things that the file can still hold."""
        word = self.word(wanted)
        if not (word.isascii() and word.isdigit()) or len(word) > 9:
            raise InvalidObjectError(f"'{word}' is not {wanted}")
        return int(word)

    def pose(self) -> RigidTransform:
        x, y, z = self.numbers(3, "a coordinate of a position")
        i, j, k, w = self.numbers(4, "a part of a quaternion")
        return RigidTransform((x, y, z), (i, j, k, w))


def _with_objects(scene: PlanningScene, links: LinkPoses, words: _Words) -> PlanningScene:
    has_poses: bool | None = None
    while True:
        marker = words.word(f"'{OBJECT}' or '{END}'")
        if marker == END:
            return scene
        if marker != OBJECT:
            raise InvalidObjectError(
                f"'{marker}' is neither '{OBJECT}', which starts an object, nor '{END}'"
            )
        name = words.line()
        if has_poses is None:
            has_poses = words.next_line_has_several()
        change, color = _object(words, name, has_poses)
        scene = change_object(scene, links, change)
        if any(color):
            scene = replace(scene, colors={**scene.colors, name: color})


def _object(words: _Words, name: str, has_poses: bool) -> tuple[ObjectChange, Rgba]:
    pose = words.pose() if has_poses else RigidTransform()
    shapes: list[PlacedShape] = []
    color = NO_COLOR
    for _ in range(words.count("a number of shapes")):
        shape = _shape(words)
        shapes.append(PlacedShape(shape, words.pose()))
        red, green, blue, alpha = words.numbers(4, "a part of a colour")
        color = (red, green, blue, alpha)
    subframes: dict[str, RigidTransform] = {}
    if has_poses:
        for _ in range(words.count("a number of subframes")):
            subframe = words.word("a subframe's name")
            subframes[subframe] = words.pose()
    each = CollisionObject(name, pose, tuple(shapes), subframes)
    return (
        ObjectChange(Operation.ADD, name, "", explicit_pose(each), each.shapes, subframes),
        color,
    )


def _shape(words: _Words) -> Shape:
    kind = words.word("a shape")
    match kind:
        case "sphere":
            return Sphere(words.number("a radius"))
        case "box":
            x, y, z = words.numbers(3, "a side of a box")
            return Box((x, y, z))
        case "cylinder":
            return Cylinder(*words.numbers(2, "a radius or length"))
        case "cone":
            return Cone(*words.numbers(2, "a radius or height"))
        case "plane":
            return Plane(*words.numbers(4, "a coefficient of a plane"))
        case "mesh":
            vertices = words.count("a number of vertices")
            triangles = words.count("a number of triangles")
            corners = words.numbers(3 * vertices, "a coordinate of a vertex")
            indices = [words.count("the number of a vertex") for _ in range(3 * triangles)]
            return TriangleMesh(
                np.array(corners, dtype=float).reshape(-1, 3),
                np.array(indices, dtype=np.int64).reshape(-1, 3),
            )
        case _:
            raise InvalidObjectError(f"'{kind}' is not a shape; there are {', '.join(KINDS)}")
