"""The checks that make links and joints one tree, and mimicking joints solvable."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from arm_description.errors import MimicCycleError, UrdfError
from arm_description.names import listing

if TYPE_CHECKING:
    from arm_description.robot import Joint, Link


def find_root(links: Sequence["Link"], joints: Sequence["Joint"]) -> str:
    """Return the one link that no joint carries, having checked that all hang on it.

    Raises:
        UrdfError: no links, a name used twice, a joint between links that do not exist, a link
            with two parents, no root or several, links in a loop.
    """
    if not links:
        raise UrdfError("the robot has no links")
    _check_unique("link", links)
    _check_unique("joint", joints)
    carriers = _carriers(links, joints)
    roots = [link for link in links if link.name not in carriers]
    if len(roots) > 1:
        names = listing(f"'{link.name}' (line {link.line})" for link in roots)
        raise UrdfError(f"a robot has one root link, but no joint has as its child any of {names}")
    if roots:
        _check_no_loop(links, carriers, roots[0].name)
        return roots[0].name
    _check_no_loop(links, carriers, None)
    raise AssertionError("links without a root hold a loop")


def check_mimics(joints: Sequence["Joint"]) -> None:
    """Check that every mimicking joint follows, over any number of others, a free one.

    Raises:
        UrdfError: a joint mimics one that does not exist.
        MimicCycleError: joints mimic each other in a circle.
    """
    by_name = {joint.name: joint for joint in joints}
    solved: set[str] = set()
    for joint in joints:
        chain: dict[str, None] = {}
        follower = joint
        while follower.mimic is not None and follower.name not in solved:
            chain[follower.name] = None
            leader = by_name.get(follower.mimic.joint)
            if leader is None:
                raise UrdfError(
                    f"line {follower.line}: joint '{follower.name}' mimics joint "
                    f"'{follower.mimic.joint}', which does not exist; the robot has "
                    f"{listing(by_name)}"
                )
            if leader.name in chain:
                raise MimicCycleError(
                    f"line {follower.line}: joints mimic each other in a circle: "
                    f"{_circle(chain, leader.name)}"
                )
            follower = leader
        solved.update(chain)


def _check_unique(kind: str, items: Sequence["Link"] | Sequence["Joint"]) -> None:
    lines: dict[str, int] = {}
    for item in items:
        if item.name in lines:
            raise UrdfError(
                f"line {item.line}: a second {kind} '{item.name}'; "
                f"the first is in line {lines[item.name]}"
            )
        lines[item.name] = item.line


def _carriers(links: Sequence["Link"], joints: Sequence["Joint"]) -> dict[str, "Joint"]:
    names = [link.name for link in links]
    known = set(names)
    carriers: dict[str, Joint] = {}
    for joint in joints:
        for role, name in (("parent", joint.parent), ("child", joint.child)):
            if name not in known:
                raise UrdfError(
                    f"line {joint.line}: joint '{joint.name}' has the {role} link '{name}', "
                    f"which does not exist; the robot has {listing(names)}"
                )
        if joint.child in carriers:
            raise UrdfError(
                f"line {joint.line}: link '{joint.child}' is the child of joint '{joint.name}' "
                f"and of joint '{carriers[joint.child].name}'; a link has one parent"
            )
        carriers[joint.child] = joint
    return carriers


def _check_no_loop(links: Sequence["Link"], carriers: dict[str, "Joint"], root: str | None) -> None:
    reached = {root}
    for link in links:
        path: dict[str, None] = {}
        name = link.name
        while name not in reached:
            if name in path:
                raise UrdfError(
                    f"line {carriers[name].line}: links that are each other's parents in a "
                    f"circle: {_circle(path, name)}"
                )
            path[name] = None
            name = carriers[name].parent
        reached.update(path)


def _circle(path: dict[str, None], back_at: str) -> str:
    names = list(path)
    return " -> ".join([*names[names.index(back_at) :], back_at])
