"""The other side of the gripper."""

from dataclasses import replace

from arm_meshes.part import BoxCollision, Part, Piece

X_AXIS = (1.0, 0.0, 0.0)


def mirrored(part: Part) -> Part:
    """Return a part with upright boxes for contacts as seen in a mirror at x = 0."""
    pieces = tuple(
        Piece(piece.mesh, piece.material, piece.solid.mirror(X_AXIS)) for piece in part.pieces
    )
    boxes = [shape for shape in part.collisions if isinstance(shape, BoxCollision)]
    collisions = tuple(
        replace(shape, centre=(-shape.centre[0], *shape.centre[1:])) for shape in boxes
    )
    body = None if part.body is None else part.body.mirror(X_AXIS)
    return replace(part, pieces=pieces, collisions=collisions, body=body)
