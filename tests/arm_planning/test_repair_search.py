import numpy as np
import pytest

from arm_planning.collision.contact import BodyKind, CollisionContact
from arm_planning.repair_search import find_by_repair

LINK = BodyKind.ROBOT_LINK
LIMITS = (np.full(20, -1.0), np.full(20, 1.0))


def pairs_apart(gap: float):
    """Each joint has a link that touches a post until it is `gap` away from zero."""

    def contacts(q):
        found = [
            CollisionContact(f"link{n}", f"post{n}", LINK, LINK, gap - abs(x), (0, 0, 0), (1, 0, 0))
            for n, x in enumerate(q)
            if abs(x) < gap
        ]
        return sorted(found, key=lambda each: -each.depth_m)

    return contacts


def its_joint(contact):
    return [int(contact.first.removeprefix("link"))]


def test_every_pair_is_moved_apart_and_not_farther_than_it_must():
    found = find_by_repair(np.zeros(20), LIMITS, pairs_apart(0.1), its_joint)
    assert found is not None
    assert np.all(np.abs(found) >= 0.1)
    assert np.all(np.abs(found) < 0.6)


def test_joints_that_have_nothing_to_do_with_it_stay():
    start = np.array([0.0, *np.linspace(0.2, 0.9, 19)])
    found = find_by_repair(start, LIMITS, pairs_apart(0.1), its_joint)
    assert found is not None
    assert found[1:].tolist() == start[1:].tolist()


def test_a_state_without_contact_is_its_own_answer():
    start = np.full(20, 0.5)
    found = find_by_repair(start, LIMITS, pairs_apart(0.1), pytest.fail)
    assert found is not None
    assert found.tolist() == start.tolist()


def test_none_is_found_where_all_states_touch():
    assert find_by_repair(np.zeros(20), LIMITS, pairs_apart(2.0), its_joint) is None


def test_a_pair_that_no_joint_moves_apart_ends_the_search():
    assert find_by_repair(np.zeros(20), LIMITS, pairs_apart(0.1), lambda _contact: []) is None
