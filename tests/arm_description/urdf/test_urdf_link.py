"""<link>: inertia, shapes and materials."""

import pytest

from arm_description import (
    Box,
    Capsule,
    Cylinder,
    Inertial,
    Link,
    Material,
    Mesh,
    Pose,
    Sphere,
    UrdfError,
    parse_urdf,
)


def link(inside: str, before: str = "", after: str = "") -> Link:
    return parse_urdf(
        f"<robot name='r'>\n{before}<link name='a'>\n{inside}</link>\n{after}</robot>"
    ).link("a")


def refusal(inside: str) -> str:
    with pytest.raises(UrdfError) as caught:
        link(inside)
    return str(caught.value).removeprefix("robot_description, ")


def visual(material: str) -> str:
    return f"<visual><geometry><sphere radius='1'/></geometry>{material}</visual>"


def test_a_link_without_anything_is_a_frame():
    assert link("") == Link("a", None, (), (), line=2)


def test_inertia_and_its_frame():
    inside = (
        "<inertial><origin xyz='1 2 3' rpy='0.1 0.2 0.3'/><mass value='2.5'/>"
        "<inertia ixx='1' ixy='2' ixz='3' iyy='4' iyz='5' izz='6'/></inertial>"
    )
    assert link(inside).inertial == Inertial(
        2.5, Pose((1, 2, 3), (0.1, 0.2, 0.3)), (1, 2, 3, 4, 5, 6)
    )


def test_products_of_inertia_are_zero_where_not_given():
    inside = "<inertial><mass value='0'/><inertia ixx='1' iyy='2' izz='3'/></inertial>"
    assert link(inside).inertial == Inertial(0.0, Pose(), (1, 0, 0, 2, 0, 3))


@pytest.mark.parametrize(
    ("shape", "geometry"),
    [
        ("<box size='1 2 3'/>", Box((1.0, 2.0, 3.0))),
        ("<cylinder radius='.5' length='2.'/>", Cylinder(0.5, 2.0)),
        ("<sphere radius='1e-2'/>", Sphere(0.01)),
        ("<capsule radius='0.1' length='+0.2'/>", Capsule(0.1, 0.2)),
        ("<mesh filename='package://a/b.stl'/>", Mesh("package://a/b.stl")),
        ("<mesh filename=' b.stl ' scale='-1 1\n1'/>", Mesh("b.stl", (-1.0, 1.0, 1.0))),
    ],
)
def test_every_shape_is_read_for_seeing_and_for_touching(shape, geometry):
    part = f"<origin xyz='0 0 1'/><geometry>{shape}</geometry>"
    read = link(f"<visual name='v'>{part}</visual><collision name='c'>{part}</collision>")
    assert [(v.name, v.origin, v.geometry) for v in read.visuals] == [
        ("v", Pose((0, 0, 1)), geometry)
    ]
    assert [(c.name, c.origin, c.geometry) for c in read.collisions] == [
        ("c", Pose((0, 0, 1)), geometry)
    ]


@pytest.mark.parametrize(
    ("inside", "message"),
    [
        ("<inertial/>", "line 3: <inertial> of link 'a' needs a <inertia>"),
        (
            "<inertial><inertia ixx='1' iyy='1' izz='1'/></inertial>",
            "line 3: <inertial> of link 'a' needs a <mass>",
        ),
        (
            "<inertial><mass value='-1'/><inertia ixx='1' iyy='1' izz='1'/></inertial>",
            "line 3: <mass> of link 'a' has value=-1; it must not be negative",
        ),
        (
            "<inertial><mass value='1'/>\n<inertia ixx='1' iyy='nan' izz='1'/></inertial>",
            "line 4: <inertia> of link 'a' has iyy='nan', which is not a finite number",
        ),
        (
            "<inertial><mass value='1'/><inertia ixx='1' iyy='1'/></inertial>",
            "line 3: <inertia> of link 'a' needs the attribute 'izz'",
        ),
        ("<visual/>", "line 3: <visual> of link 'a' needs a <geometry>"),
        (
            "<collision><geometry/></collision>",
            "line 3: <geometry> of link 'a' has no shape; it takes one of "
            "box, cylinder, sphere, capsule, mesh",
        ),
        (
            "<collision><geometry><sphere radius='-1'/></geometry></collision>",
            "line 3: <sphere> of link 'a' has radius=-1; it must not be negative",
        ),
        (
            "<collision><geometry><box size='1 2'/></geometry></collision>",
            "line 3: <box> of link 'a' has size='1 2': 2 values, not 3",
        ),
        (
            "<collision><geometry><box size='1 -2 1'/></geometry></collision>",
            "line 3: <box> of link 'a' has size='1 -2 1'; no side may be negative",
        ),
        (
            "<collision><geometry><mesh/></geometry></collision>",
            "line 3: <mesh> of link 'a' needs the attribute 'filename'",
        ),
        (
            "<collision><origin xyz='0 inf 0'/><geometry><sphere radius='1'/></geometry>"
            "</collision>",
            "line 3: <origin> of link 'a' has xyz='inf', which is not a finite number",
        ),
        (
            "<collision><geometry><sphere radius='1_0'/></geometry></collision>",
            "line 3: <sphere> of link 'a' has radius='1_0', which is not a finite number",
        ),
        (
            "<collision><geometry><sphere radius='1e999'/></geometry></collision>",
            "line 3: <sphere> of link 'a' has radius='1e999', which is not a finite number",
        ),
        (
            visual("<material name='m'><color rgba='1 0 0'/></material>"),
            "line 3: <color> of link 'a' has rgba='1 0 0': 3 values, not 4",
        ),
    ],
)
def test_an_error_names_line_element_and_link(inside, message):
    assert refusal(inside) == message


RED = (1.0, 0.0, 0.0, 1.0)
COLOUR = "<color rgba='1 0 0 1'/>"


def test_a_visuals_own_colour_and_texture():
    texture = "<texture filename='t.png'/>"
    read = link(visual(f"<material name='m'>{COLOUR}{texture}</material>"))
    assert read.visuals[0].material == Material("m", RED, "t.png")


def test_a_texture_without_a_file_is_ignored_as_urdfdom_ignores_it():
    read = link(visual(f"<material name='m'>{COLOUR}<texture/></material>"))
    assert read.visuals[0].material == Material("m", RED)


def test_a_visual_without_a_material_has_none():
    assert link(visual("")).visuals[0].material is None


@pytest.mark.parametrize("position", ["before", "after"])
def test_a_material_of_the_robot_resolves_in_any_position(position):
    read = link(
        visual("<material name='m'/>"), **{position: f"<material name='m'>{COLOUR}</material>"}
    )
    assert read.visuals[0].material == Material("m", RED)


def test_a_material_of_an_earlier_link_resolves():
    shape = visual(f"<material name='m'>{COLOUR}</material>")
    earlier = f"<link name='b'>{shape}</link>"
    after = "<joint name='j' type='fixed'><parent link='b'/><child link='a'/></joint>"
    read = link(visual("<material name='m'/>"), before=earlier, after=after)
    assert read.visuals[0].material == Material("m", RED)


def test_a_visuals_own_colour_overrides_the_robots():
    own = visual("<material name='m'><color rgba='0 1 0 1'/></material>")
    read = link(own, before=f"<material name='m'>{COLOUR}</material>")
    assert read.visuals[0].material == Material("m", (0.0, 1.0, 0.0, 1.0))


def test_a_material_without_a_name_is_not_carried_over():
    named = visual(f"<material name=''>{COLOUR}</material>")
    read = link(named + visual("<material name=''/>") + visual(""))
    assert [v.material for v in read.visuals] == [Material("", RED), Material(""), None]


def test_a_material_that_is_only_a_name_stays_one():
    assert link(visual("<material name='green'/>")).visuals[0].material == Material("green")


def test_a_colour_out_of_range_is_brought_into_it_with_a_warning(caplog):
    read = link(visual("<material name='m'><color rgba='255 0 -1 1'/></material>"))
    assert read.visuals[0].material == Material("m", RED)
    assert "line 3: <color> of link 'a' has rgba='255 0 -1 1'" in caplog.text


def test_of_a_repeated_element_the_first_one_is_used_with_a_warning(caplog):
    geometry = (
        "<geometry><sphere radius='1'/></geometry>\n<geometry><sphere radius='2'/></geometry>"
    )
    assert link(f"<collision>{geometry}</collision>").collisions[0].geometry == Sphere(1.0)
    assert "line 4: <geometry> of link 'a' is the second one; the one in line 3" in caplog.text
