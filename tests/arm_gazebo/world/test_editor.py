import numpy as np
import pytest

from arm_gazebo.errors import Refusal, RequestError
from arm_gazebo.physics.stepped_shapes import SteppedShapes
from arm_gazebo.world.editor import SpawnRequest
from arm_gazebo.world.entity import Category, EntityNote


@pytest.fixture
def world(kept, parts):
    return kept(robot=parts.pendulum())


def refusal(action) -> tuple[Refusal, str]:
    """Return why an action is refused, and check that the sentence is one."""
    with pytest.raises(RequestError) as caught:
        action()
    message = str(caught.value)
    assert message
    assert "Traceback" not in message
    return caught.value.refusal, message


def test_robots_and_things_of_the_world_are_entities(world):
    categories = {e.name: e.note.category for e in world.editor.entities}
    assert categories["bench"] is Category.ROBOT
    assert categories["red_cylinder"] is Category.DYNAMIC_OBJECT
    assert categories["mustard"] is Category.STATIC_OBJECT


@pytest.mark.parametrize("text", ["crate", "chest", "ball", "puck"])
def test_a_spawned_model_starts_at_its_pose_and_falls(world, things, text):
    assert world.spawn("thing", getattr(things, text), things.at(2, 1, 1)) == "thing"
    assert world.where("thing") == pytest.approx([2, 1, 1], abs=1e-9)
    world.arm.run(0.2)
    assert world.where("thing")[2] == pytest.approx(1 - 0.5 * 9.81 * 0.04, abs=0.02)


def test_drawn_shapes_are_where_their_things_are_while_a_step_runs(world, things):
    model = world.arm.simulation.model
    stepped = SteppedShapes(model)

    def between_two_ticks(function):
        stepped.show()
        result = function()
        stepped.hide()
        return result

    world.editor.on_loop = between_two_ticks
    stepped.hide()
    world.editor.place("red_cylinder", things.at(1, 1, 0.175), "", None)
    positions, _ = world.editor.motions().geom_poses
    stepped.show()

    body = model.body("red_cylinder")
    touching, drawn = range(body.geomadr[0], body.geomadr[0] + body.geomnum[0])
    assert not model.geom_contype[drawn]
    assert positions[[touching, drawn]] == pytest.approx(np.tile([1, 1, 0.175], (2, 1)))


def test_a_static_model_stays_at_its_pose(world, things):
    world.spawn("post", things.post, things.at(2, 1, 1))
    world.arm.run(0.2)
    assert world.where("post") == pytest.approx([2, 1, 1])
    assert world.editor.entities.find("post").note.category is Category.STATIC_OBJECT


def turned(x: float, y: float, z: float) -> np.ndarray:
    """Return a pose (4, 4) with a quarter turn about z."""
    return np.array([[0, -1, 0, x], [1, 0, 0, y], [0, 0, 1, z], [0, 0, 0, 1.0]])


def test_a_model_with_a_world_root_keeps_the_origin_of_its_first_joint(world, things):
    world.spawn("lamp", things.lamp.format(joint="fixed"), turned(2, 1, 0))
    for pose in (turned(2, 1, 0), turned(3, 2, 1)):
        world.editor.place("lamp", pose, "", None)
        motions = world.editor.motions()
        assert motions.of(world.editor.entities.find("lamp")).pose == pytest.approx(pose)
        assert motions.pose("lamp::base")[:3, 3] == pytest.approx(pose[:3, 3] + [-0.5, 0, 1])
        assert motions.pose("lamp::base")[:3, 0] == pytest.approx([-1, 0, 0])
    world.spawn("post", things.post, things.at(), frame="lamp")
    assert world.where("post") == pytest.approx([3, 2, 1])


def test_a_thing_that_floats_in_its_world_link_is_moved_and_pushed_by_its_own_frame(world, things):
    world.spawn("kite", things.lamp.format(joint="floating"), turned(2, 1, 0))
    entity = world.editor.entities.find("kite")
    world.editor.place("kite", turned(3, 2, 1), "", np.array([1.0, 0, 0, 0, 0, 2.0]))
    motion = world.editor.motions().of(entity)
    assert motion.pose == pytest.approx(turned(3, 2, 1))
    assert motion.linear == pytest.approx([1, 0, 0])
    assert motion.angular == pytest.approx([0, 0, 2])
    base = world.editor.motions().motion("kite::base")
    assert base.pose[:3, 3] == pytest.approx([2.5, 2, 2])
    assert base.linear == pytest.approx([1, -1, 0])


def test_poses_may_be_given_in_the_frame_of_an_entity_or_link(world, things):
    can = world.where("coke_can")
    world.spawn("a", things.post, things.at(z=0.5), frame="coke_can")
    assert world.where("a") == pytest.approx(can + np.array([0, 0, 0.5]), abs=1e-6)
    world.spawn("b", things.post, things.at(), frame="a::base")
    assert world.where("b") == pytest.approx(world.where("a"))


def test_names_are_kept_unique(world, things):
    world.spawn("crate", things.crate, things.at(2, 1, 1))
    kind, message = refusal(lambda: world.spawn("crate", things.crate, things.at(3, 1, 1)))
    assert kind is Refusal.NAME_NOT_UNIQUE
    assert "'crate'" in message
    for _ in range(2):
        world.spawn("crate", things.crate, things.at(3, 1, 1), allow_renaming=True)
    assert {"crate", "crate_2", "crate_3"} <= set(world.names())


def test_an_unnamed_entity_gets_a_name_if_renaming_is_allowed(world, things):
    assert world.spawn("", things.puck, things.at(2, 1, 1), allow_renaming=True) == "thing"
    assert refusal(lambda: world.spawn("", things.puck, things.at()))[0] is Refusal.NAME_INVALID


@pytest.mark.parametrize("name", ["a b", "a/b", "a::b", "ä", "x" * 101, "\n", "<a>"])
def test_invalid_names_are_refused(world, things, name):
    assert refusal(lambda: world.spawn(name, things.crate, things.at()))[0] is Refusal.NAME_INVALID


def test_the_name_of_the_world_is_taken(world, things):
    kind, _ = refusal(lambda: world.spawn("world", things.crate, things.at()))
    assert kind is Refusal.NAME_NOT_UNIQUE


@pytest.mark.parametrize("namespace", ["1a", "a//b", "a b", "/", "a/"])
def test_invalid_namespaces_are_refused(world, things, namespace):
    kind, _ = refusal(lambda: world.spawn("a", things.crate, things.at(), namespace=namespace))
    assert kind is Refusal.NAMESPACE_INVALID


def test_an_unknown_frame_is_refused_before_anything_is_read(world, things):
    kind, message = refusal(lambda: world.spawn("a", "<nonsense", things.at(), frame="nowhere"))
    assert kind is Refusal.INVALID_POSE
    assert "'nowhere'" in message


def test_deleted_things_are_gone_and_their_names_free(world, things):
    world.spawn("crate", things.crate, things.at(2, 1, 1))
    world.editor.delete("crate")
    world.editor.delete("red_cylinder")
    assert not {"crate", "red_cylinder"} & set(world.names())
    assert refusal(lambda: world.editor.delete("crate"))[0] is Refusal.NOT_FOUND
    world.spawn("red_cylinder", things.puck, things.at(2, 1, 1))
    assert world.where("red_cylinder") == pytest.approx([2, 1, 1])


def test_a_robot_cannot_be_deleted(world):
    kind, message = refusal(lambda: world.editor.delete("bench"))
    assert kind is Refusal.FAILED
    assert "robot" in message


def test_a_free_entity_is_moved_and_pushed_while_paused(world, things):
    world.editor.place("coke_can", things.at(1, 1, 1), "", np.array([1.0, 0, 0, 0, 0, 2.0]))
    motion = world.editor.motions().motion("coke_can")
    assert motion.pose[:3, 3] == pytest.approx([1, 1, 1])
    assert motion.linear == pytest.approx([1, 0, 0])
    assert motion.angular == pytest.approx([0, 0, 2])


def test_a_velocity_alone_does_not_move_an_entity(world):
    before = world.where("coke_can")
    world.editor.place("coke_can", None, "", np.array([0, 0, 3.0, 0, 0, 0]))
    assert world.where("coke_can") == pytest.approx(before)
    world.arm.run(0.1)
    assert world.where("coke_can")[2] > before[2] + 0.2


def test_a_pose_alone_stops_a_thing(world, things):
    world.editor.place("coke_can", None, "", np.ones(6))
    world.editor.place("coke_can", things.at(1, 1, 1), "", None)
    assert world.editor.motions().motion("coke_can").linear == pytest.approx(np.zeros(3))


def test_velocities_are_rotated_from_their_frame(world, things):
    turned = things.at(2, 2, 1)
    turned[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    world.spawn("post", things.post, turned)
    world.editor.place("coke_can", things.at(1, 0, 0), "post", np.array([1.0, 0, 0, 1, 0, 0]))
    motion = world.editor.motions().motion("coke_can")
    assert motion.pose[:3, 3] == pytest.approx([2, 3, 1])
    assert motion.linear == pytest.approx([0, 1, 0])
    assert motion.angular == pytest.approx([0, 1, 0])


def test_a_static_entity_can_be_moved(world, things):
    world.spawn("post", things.post, things.at(2, 1, 1))
    for name in ("post", "mustard"):
        world.editor.place(name, things.at(3, 2, 1), "", None)
        assert world.where(name) == pytest.approx([3, 2, 1])
    world.arm.run(0.1)
    assert world.where("mustard") == pytest.approx([3, 2, 1])


def test_a_static_entity_in_an_mjcf_frame_can_be_moved(kept, parts, things, tmp_path):
    file = tmp_path / "world.xml"
    file.write_text(
        "<mujoco><worldbody><frame pos='1 0 0' euler='0 0 90'><frame pos='0 1 0'>"
        "<body name='wall' pos='0 0 1'><geom size='0.1'/></body></frame></frame>"
        "</worldbody></mujoco>"
    )
    world = kept(str(file), robot=parts.pendulum())
    start = world.where("wall")
    for x in (3, 4):
        world.editor.place("wall", things.at(x, 2, 1), "", None)
        assert world.editor.motions().pose("wall") == pytest.approx(things.at(x, 2, 1))
    world.reset(spawned=False)
    assert world.where("wall") == pytest.approx(start)


def test_a_mocap_body_can_be_put_elsewhere(kept, parts, things, tmp_path):
    file = tmp_path / "world.xml"
    file.write_text(
        "<mujoco><worldbody><body name='hand' mocap='true' pos='1 0 1'><geom size='0.1'/></body>"
        "</worldbody></mujoco>"
    )
    world = kept(str(file), robot=parts.pendulum())
    world.editor.place("hand", things.at(3, 2, 1), "", None)
    world.spawn("post", things.post, things.at(5, 5, 1))
    assert world.where("hand") == pytest.approx([3, 2, 1])
    world.reset(spawned=False)
    assert world.where("hand") == pytest.approx([1, 0, 1])


def test_what_cannot_move_takes_no_velocity(world):
    kind, _ = refusal(lambda: world.editor.place("mustard", None, "", np.ones(6)))
    assert kind is Refusal.FAILED


def test_a_robot_that_is_bolted_down_stays(world, things):
    kind, message = refusal(lambda: world.editor.place("bench", things.at(1), "", None))
    assert kind is Refusal.FAILED
    assert "bolted" in message


def test_reset_brings_the_world_of_the_start_back(world, things):
    start = world.where("coke_can")
    world.spawn("crate", things.crate, things.at(2, 1, 1))
    world.editor.delete("red_cylinder")
    world.editor.place("mustard", things.at(3, 2, 1), "", None)
    world.editor.place("coke_can", things.at(1, 1, 1), "", None)
    before_s = world.arm.simulation.time_s
    world.reset(spawned=True)
    assert sorted(world.names()) == sorted(
        ["bench", "red_cylinder", "mustard", "cheezit_big_original", "cardboard_box", "coke_can"]
    )
    assert world.where("coke_can") == pytest.approx(start)
    assert world.where("mustard")[0] == pytest.approx(0.7)
    assert world.arm.simulation.time_s == before_s


def test_reset_of_the_state_alone_keeps_what_was_spawned(world, things):
    world.spawn("crate", things.crate, things.at(2, 1, 1))
    world.arm.run(0.3)
    world.reset(spawned=False)
    assert world.where("crate") == pytest.approx([2, 1, 1])


def test_resetting_the_state_returns_moved_static_entities(world, things):
    world.spawn("post", things.post, things.at(2, 1, 1))
    before = {name: world.where(name).copy() for name in ("post", "mustard")}
    for name in before:
        world.editor.place(name, things.at(3, 2, 1), "", None)
    world.reset(spawned=False)
    for name, place in before.items():
        assert world.where(name) == pytest.approx(place)


def test_an_entity_that_was_moved_and_deleted_is_restored_at_its_original_pose(world, things):
    world.spawn("post", things.post, things.at(2, 1, 1))
    world.editor.place("post", things.at(3, 2, 1), "", None)
    world.editor.delete("post")
    world.spawn("post", things.post, things.at(4, 1, 1))
    assert world.where("post") == pytest.approx([4, 1, 1])


def test_a_clients_information_about_an_entity_is_kept_until_it_is_deleted(world, things):
    world.spawn("crate", things.crate, things.at(2, 1, 1))
    note = EntityNote(Category.DYNAMIC_OBJECT, "fragile", ("glass",))
    world.editor.describe("crate", note)
    world.spawn("other", things.crate, things.at(3, 1, 1))
    assert world.editor.entities.find("crate").note == note
    world.editor.delete("crate")
    world.spawn("crate", things.crate, things.at(2, 1, 1))
    assert world.editor.entities.find("crate").note.description == "spawned from URDF"


def test_nothing_becomes_a_robot_by_being_called_one(world):
    note = EntityNote(Category.ROBOT)
    assert refusal(lambda: world.editor.describe("mustard", note))[0] is Refusal.FAILED


def test_bounds_follow_the_entity(world, things):
    world.spawn("crate", things.crate, things.at(2, 1, 1))
    entity = world.editor.entities.find("crate")
    motions = world.editor.motions()
    assert motions.bounds(entity).ravel() == pytest.approx([1.95, 0.95, 0.95, 2.05, 1.05, 1.05])
    own = motions.bounds(entity, motions.pose("crate::base"))
    assert own.ravel() == pytest.approx([-0.05] * 3 + [0.05] * 3)


def test_a_thing_that_does_not_fit_leaves_everything_as_it_was(world, things):
    model = world.editor.model
    assert refusal(lambda: world.spawn("a", "<mujoco/>", things.at()))[0] is Refusal.UNREADABLE
    assert world.editor.model is model
    assert world.arm.simulation.model is model


def test_a_file_is_read_by_its_uri(world, things, tmp_path):
    file = tmp_path / "crate.urdf"
    file.write_text(things.crate)
    request = SpawnRequest("crate", file.as_uri(), "<nonsense", things.at(2, 1, 1))
    assert world.editor.spawn(request) == "crate"
