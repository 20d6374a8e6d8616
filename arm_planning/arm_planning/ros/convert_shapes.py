"""Converts the shapes of objects from and to messages."""

from collections.abc import Iterable, Sequence

import numpy as np
from geometry_msgs.msg import Point, Pose
from shape_msgs.msg import Mesh, MeshTriangle, SolidPrimitive
from shape_msgs.msg import Plane as PlaneMessage

from arm_description.urdf.robot import Box, Cylinder, Sphere
from arm_node.rigid_transform import RigidTransform
from arm_planning.errors import InvalidObjectError
from arm_planning.ros.convert import pose_of
from arm_planning.scene.object_checks import shape_problem
from arm_planning.scene.objects import PlacedShape
from arm_planning.scene.shapes import Cone, Plane, Shape, TriangleMesh

SIZES = {
    SolidPrimitive.BOX: ("box", ("x", "y", "z")),
    SolidPrimitive.SPHERE: ("sphere", ("radius",)),
    SolidPrimitive.CYLINDER: ("cylinder", ("height", "radius")),
    SolidPrimitive.CONE: ("cone", ("height", "radius")),
}


def placed_shapes(
    owner: str,
    primitives: Iterable[SolidPrimitive],
    primitive_poses: Iterable[Pose],
    meshes: Iterable[Mesh],
    mesh_poses: Iterable[Pose],
    planes: Iterable[PlaneMessage] = (),
    plane_poses: Iterable[Pose] = (),
) -> tuple[PlacedShape, ...]:
    """Return the shapes of an object; a shape without a pose is at the origin.

    There may be fewer poses than shapes, but not more. Errors name the owner, such as "object
    'box1'".

    Raises:
        PlanningError: INVALID_OBJECT_NAME: a shape has no size, or there are more poses than
            shapes.
    """
    return (
        *_placed(owner, "primitive", [_solid(owner, each) for each in primitives], primitive_poses),
        *_placed(owner, "mesh", [_mesh(owner, each) for each in meshes], mesh_poses),
        *_placed(owner, "plane", [_plane(owner, each) for each in planes], plane_poses),
    )


def solid_message(shape: Shape) -> SolidPrimitive | Mesh | PlaneMessage:
    """Return a shape as the message of its kind."""
    match shape:
        case Box(size):
            return _primitive(SolidPrimitive.BOX, size)
        case Sphere(radius):
            return _primitive(SolidPrimitive.SPHERE, (radius,))
        case Cylinder(radius, length):
            return _primitive(SolidPrimitive.CYLINDER, (length, radius))
        case Cone(radius, height):
            return _primitive(SolidPrimitive.CONE, (height, radius))
        case Plane(a, b, c, d):
            return PlaneMessage(coef=[float(number) for number in (a, b, c, d)])
        case TriangleMesh(vertices, triangles):
            return Mesh(
                vertices=[Point(x=x, y=y, z=z) for x, y, z in vertices.tolist()],
                triangles=[MeshTriangle(vertex_indices=row) for row in triangles.tolist()],
            )


def _primitive(kind: int, sizes: Iterable[float]) -> SolidPrimitive:
    return SolidPrimitive(type=kind, dimensions=[float(size) for size in sizes])


def _placed(
    owner: str, kind: str, shapes: Sequence[Shape], poses: Iterable[Pose]
) -> list[PlacedShape]:
    what = f"a {kind} of {owner}"
    for shape in shapes:
        if problem := shape_problem(shape):
            raise InvalidObjectError(f"{owner} has a {problem}")
    placed = [pose_of(pose, what) for pose in poses]
    if len(placed) > len(shapes):
        raise InvalidObjectError(f"{owner} has {len(placed)} {kind} poses for {len(shapes)} shapes")
    placed += [RigidTransform()] * (len(shapes) - len(placed))
    return [PlacedShape(shape, pose) for shape, pose in zip(shapes, placed, strict=True)]


def _solid(owner: str, message: SolidPrimitive) -> Shape:
    if message.type not in SIZES:
        raise InvalidObjectError(
            f"{owner} has a primitive of type {message.type}; there are 1 (box), 2 (sphere), "
            "3 (cylinder) and 4 (cone)"
        )
    name, wanted = SIZES[message.type]
    sizes = list(message.dimensions)
    if len(sizes) != len(wanted):
        raise InvalidObjectError(
            f"{owner} has a {name} of {len(sizes)} dimensions; it has {', '.join(wanted)}"
        )
    match message.type:
        case SolidPrimitive.BOX:
            x, y, z = sizes
            return Box((x, y, z))
        case SolidPrimitive.SPHERE:
            return Sphere(sizes[0])
        case SolidPrimitive.CYLINDER:
            return Cylinder(radius=sizes[1], length=sizes[0])
        case _:
            return Cone(radius=sizes[1], height=sizes[0])


def _mesh(owner: str, message: Mesh) -> TriangleMesh:
    vertices = np.array([(v.x, v.y, v.z) for v in message.vertices], dtype=float).reshape(-1, 3)
    triangles = np.array([list(t.vertex_indices) for t in message.triangles], dtype=np.int64)
    triangles = triangles.reshape(-1, 3)
    return TriangleMesh(vertices, triangles)


def _plane(owner: str, message: PlaneMessage) -> Plane:
    a, b, c, d = map(float, message.coef)
    return Plane(a, b, c, d)
