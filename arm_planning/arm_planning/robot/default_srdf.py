"""Makes planning groups for a robot without an SRDF: arms, grippers, and their named states.

Links that no joint moves against each other are one body. A gripper is a body at the end of a chain
with everything that it carries: two or more short branches, or one that is called so. What is left
is a tree of chains; each of its branches is a group.
"""

from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from arm_description import forward_kinematics
from arm_description.urdf.robot import Joint, Robot
from arm_planning.robot.srdf import EndEffector, Pair, Srdf, SrdfGroup

FINGERS = ("grip", "finger", "jaw", "claw")
"""Parts of names that tell a branch of a gripper."""
TIPS = ("tcp", "tool0", "grasp", "tool", "flange")
"""Parts of names of frames that are made for poses, the best first."""
SIDES = ("left", "right")
DIFFERENT_M = 1e-6
"""By how much fingers must move to tell open from closed."""


@dataclass(frozen=True, slots=True)
class _Gripper:
    """A body that carries fingers: its `palm`, the link that most of them are joined to."""

    palm: str
    joints: tuple[Joint, ...]


def default_srdf(robot: Robot) -> Srdf:
    """Return an SRDF with groups, states and end effectors, without allowed collisions."""
    tree = _Tree(robot)
    grippers = list(tree.grippers())
    fingers = {joint.name for gripper in grippers for joint in gripper.joints}
    # The first one moves where nobody names a group: an arm, not a wheel.
    chains = sorted(tree.chains(fingers), key=len, reverse=True)
    names = _chain_names(chains)
    groups: dict[str, SrdfGroup] = {}
    states: dict[Pair, Mapping[str, tuple[float, ...]]] = {}
    for name, chain in zip(names, chains, strict=True):
        tip = _tip(robot, tree.rigid(chain[-1].child), chain[-1].child, grippers)
        groups[name] = SrdfGroup(chains=((chain[0].parent, tip),))
        states[name, "home"] = _home(chain)
    end_effectors: dict[str, EndEffector] = {}
    for gripper in grippers:
        arm = next(
            (
                name
                for name, chain in zip(names, chains, strict=True)
                if gripper.palm in tree.rigid(chain[-1].child)
            ),
            "",
        )
        name = _gripper_name(arm, gripper, len(grippers), groups)
        groups[name] = SrdfGroup(joints=tuple(joint.name for joint in gripper.joints))
        states |= {(name, state): values for state, values in _grips(robot, gripper).items()}
        end_effectors[name] = EndEffector(gripper.palm, name, arm)
        if arm:
            both = f"{arm}_with_{name}"
            groups[both] = SrdfGroup(subgroups=(arm, name))
            states[both, "home"] = {**states[arm, "home"], **_home(gripper.joints)}
    return Srdf(robot.name, groups=groups, states=states, end_effectors=end_effectors)


class _Tree:
    """A robot as bodies that joints move against each other."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._body = {robot.root: robot.root}
        self._moving: dict[str, list[Joint]] = {}
        self._links: dict[str, list[str]] = {robot.root: [robot.root]}
        self._above: dict[str, int] = {robot.root: 0}
        for joint in robot.joints_in_tree_order:
            body = self._body[joint.parent]
            if joint.type.is_scalar:
                self._moving.setdefault(body, []).append(joint)
                self._above[joint.child] = self._above[body] + 1
                body = joint.child
            self._body[joint.child] = body
            self._links.setdefault(body, []).append(joint.child)

    def rigid(self, link: str) -> list[str]:
        """Return the links of the body that a link belongs to, in tree order."""
        return self._links[self._body[link]]

    def below(self, joint: Joint) -> list[Joint]:
        """Return a joint and all moving ones that it carries."""
        found = [joint]
        for each in found:
            found.extend(self._moving.get(each.child, ()))
        return found

    def grippers(self) -> Iterator[_Gripper]:
        """Yield the grippers, none of them inside another."""
        waiting = [self._robot.root]
        while waiting:
            body = waiting.pop()
            joints = self._moving.get(body, [])
            branches = [self.below(joint) for joint in joints]
            if self._is_gripper(body, branches):
                palms = [joint.parent for joint in joints]
                inside = [joint for branch in branches for joint in branch]
                yield _Gripper(max(palms, key=palms.count), self._in_order(inside))
            else:
                waiting.extend(joint.child for joint in reversed(joints))

    def chains(self, fingers: Container[str]) -> list[list[Joint]]:
        """Return the chains between bodies that carry several; fingers are left out.

        A chain has a joint that does not follow another one.
        """
        result: list[list[Joint]] = []
        waiting = list(reversed(self._joints_of(self._robot.root, fingers)))
        while waiting:
            chain = [waiting.pop()]
            after = self._joints_of(chain[-1].child, fingers)
            while len(after) == 1:
                chain.append(after[0])
                after = self._joints_of(chain[-1].child, fingers)
            if any(joint.mimic is None for joint in chain):
                result.append(chain)
            waiting.extend(reversed(after))
        return result

    def _joints_of(self, body: str, fingers: Container[str]) -> list[Joint]:
        """Return the joints that a body carries, without fingers and what only follows others."""
        return [
            joint
            for joint in self._moving.get(body, ())
            if joint.name not in fingers and any(each.mimic is None for each in self.below(joint))
        ]

    def _is_gripper(self, body: str, branches: Sequence[Sequence[Joint]]) -> bool:
        """Return whether the branches of a body are fingers.

        They do not all follow joints elsewhere. They are shorter than what carries them; and they
        are called so, or move together, or slide, or are many, or have one joint each.
        """
        above = self._above[body]
        joints = [joint for branch in branches for joint in branch]
        if all(joint.mimic is not None for joint in joints):
            return False
        deepest = max(self._above[joint.child] for joint in joints) - above
        leaders = {joint.mimic.joint for joint in joints if joint.mimic is not None}
        is_driven = all(
            joint.mimic is not None
            or joint.name in leaders
            or joint.type.slides
            or _is_finger(joint)
            for joint in joints
        )
        if len(branches) == 1:
            if self._moving.get(joints[0].child) and _turns_a_gripper(joints[0]):
                return False
            return 0 < deepest <= above and all(map(_is_finger, joints))
        if leaders and is_driven:
            return deepest <= max(above, 2)
        return 0 < deepest <= above and (is_driven or len(branches) > 2 or deepest == 1)

    def _in_order(self, joints: Sequence[Joint]) -> tuple[Joint, ...]:
        names = {joint.name for joint in joints}
        return tuple(joint for joint in self._robot.joints_in_tree_order if joint.name in names)


def _is_finger(joint: Joint) -> bool:
    return any(word in name.lower() for word in FINGERS for name in (joint.name, joint.child))


def _turns_a_gripper(joint: Joint) -> bool:
    """Return whether a joint with a name of the arm's carries a link that is called a gripper."""
    return "grip" in joint.child.lower() and not any(w in joint.name.lower() for w in FINGERS)


def _tip(robot: Robot, body: Sequence[str], first: str, grippers: Sequence[_Gripper]) -> str:
    """Return the link of a body that poses are for: a frame made for it, the palm, or the last."""
    carriers = {joint.child: joint.parent for joint in robot.joints}
    leaves = [link for link in body if not any(carriers.get(each) == link for each in body)]
    for word in TIPS:
        for link in leaves:
            if word in link.lower() and not robot.children(link):
                return link
    palms = [gripper.palm for gripper in grippers if gripper.palm in body]
    return (palms or leaves[-1:] or [first])[0]


def _chain_names(chains: Sequence[Sequence[Joint]]) -> list[str]:
    """Name the longest chains arms, by their sides if there are several, and others by tips."""
    longest = max((len(chain) for chain in chains), default=0)
    arms = [chain for chain in chains if len(chain) == longest]
    names: list[str] = []
    for chain in chains:
        tip = chain[-1].child
        side = next((side for side in SIDES if any(side in j.name + j.child for j in chain)), "")
        if len(chain) < longest:
            name = tip
        elif len(arms) == 1:
            name = "arm"
        else:
            name = f"{side}_arm" if side else f"arm_{tip}"
        names.append(name if name not in names else f"arm_{tip}")
    return names


def _gripper_name(arm: str, gripper: _Gripper, count: int, groups: Mapping[str, SrdfGroup]) -> str:
    side = next((side for side in SIDES if arm.startswith(side)), "")
    name = "gripper" if count == 1 else f"{side}_gripper" if side else f"gripper_{gripper.palm}"
    return name if name not in groups else f"gripper_{gripper.palm}"


def _home(joints: Sequence[Joint]) -> dict[str, tuple[float, ...]]:
    """Return 0 for each joint, or its limit that is nearest to 0."""
    result: dict[str, tuple[float, ...]] = {}
    for joint in joints:
        if joint.mimic is None:
            lower, upper = (joint.limit.lower, joint.limit.upper) if joint.limit else (0.0, 0.0)
            result[joint.name] = (min(max(0.0, lower), upper),)
    return result


def _grips(robot: Robot, gripper: _Gripper) -> dict[str, Mapping[str, tuple[float, ...]]]:
    """Return the states open and closed: all at the limits where the fingers are farther apart.

    Fingers are where their collision shapes are. Those that do not get farther apart have only the
    state home.
    """
    home = _home(gripper.joints)
    leaders = [joint for joint in gripper.joints if joint.name in home]
    if any(joint.type.wraps or joint.limit is None for joint in leaders):
        return {"home": home}
    limits = {joint.name: joint.limit for joint in leaders if joint.limit}
    lower = {name: limit.lower for name, limit in limits.items()}
    upper = {name: limit.upper for name, limit in limits.items()}
    width, other = (_spread(robot, gripper, each) for each in (lower, upper))
    if abs(width - other) < DIFFERENT_M:
        return {"home": home}
    opened, closed = (upper, lower) if other > width else (lower, upper)
    return {
        "open": {name: (value,) for name, value in opened.items()},
        "closed": {name: (value,) for name, value in closed.items()},
    }


def _spread(robot: Robot, gripper: _Gripper, positions: Mapping[str, float]) -> float:
    """Return the mean distance between the ends of fingers, in m."""
    carried = {joint.parent for joint in gripper.joints}
    ends = [joint.child for joint in gripper.joints if joint.child not in carried]
    poses = forward_kinematics(robot, positions)
    ends = ends if len(ends) > 1 else [*ends, gripper.palm]
    points = [poses[link] @ [*_middle(robot, link), 1.0] for link in ends]
    return float(np.mean([np.linalg.norm(one - other) for one, other in combinations(points, 2)]))


def _middle(robot: Robot, link: str) -> Sequence[float]:
    shapes = robot.link(link).collisions or robot.link(link).visuals
    return (
        np.mean([shape.origin.xyz for shape in shapes], axis=0).tolist() if shapes else (0.0,) * 3
    )
