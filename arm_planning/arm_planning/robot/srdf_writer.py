"""Writes an SRDF as text, which `parse_srdf` reads again."""

from collections.abc import Iterator
from xml.sax.saxutils import quoteattr

from arm_planning.robot.srdf import Srdf, SrdfGroup


def srdf_text(srdf: Srdf) -> str:
    """Return the text of an SRDF."""
    lines = [
        f"<robot {_attributes(name=srdf.robot_name)}>",
        *(f"  {line}" for line in _parts(srdf)),
        "</robot>",
    ]
    return "\n".join(['<?xml version="1.0"?>', *lines, ""])


def _parts(srdf: Srdf) -> Iterator[str]:
    for name, group in srdf.groups.items():
        yield from _block("group", _attributes(name=name), _members(group))
    for (group, name), values in srdf.states.items():
        joints = [
            _empty("joint", name=joint, value=" ".join(f"{number!r}" for number in numbers))
            for joint, numbers in values.items()
        ]
        yield from _block("group_state", _attributes(name=name, group=group), joints)
    for name, each in srdf.end_effectors.items():
        more = {"parent_group": each.parent_group} if each.parent_group else {}
        yield _empty(
            "end_effector", name=name, parent_link=each.parent_link, group=each.group, **more
        )
    for each in srdf.virtual_joints:
        yield _empty(
            "virtual_joint",
            name=each.name,
            type=each.type,
            parent_frame=each.parent_frame,
            child_link=each.child_link,
        )
    for name in srdf.passive_joints:
        yield _empty("passive_joint", name=name)
    for (joint, name), value in srdf.properties.items():
        yield _empty("joint_property", joint_name=joint, property_name=name, value=value)
    for link in srdf.touching:
        yield _empty("disable_default_collisions", link=link)
    for first, second in srdf.enabled:
        yield _empty("enable_collisions", link1=first, link2=second)
    for (first, second), reason in srdf.disabled.items():
        yield _empty("disable_collisions", link1=first, link2=second, reason=reason)


def _members(group: SrdfGroup) -> list[str]:
    return [
        *(_empty("joint", name=name) for name in group.joints),
        *(_empty("link", name=name) for name in group.links),
        *(_empty("chain", base_link=base, tip_link=tip) for base, tip in group.chains),
        *(_empty("group", name=name) for name in group.subgroups),
    ]


def _block(tag: str, attributes: str, inside: list[str]) -> Iterator[str]:
    if not inside:
        yield f"<{tag} {attributes}/>"
        return
    yield f"<{tag} {attributes}>"
    yield from (f"  {line}" for line in inside)
    yield f"</{tag}>"


def _empty(tag: str, **attributes: str) -> str:
    return f"<{tag} {_attributes(**attributes)}/>"


def _attributes(**attributes: str) -> str:
    return " ".join(f"{name}={quoteattr(value)}" for name, value in attributes.items())
