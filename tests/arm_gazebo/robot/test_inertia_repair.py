import numpy as np
import pytest

from arm_description.urdf.robot import Inertial, Pose
from arm_gazebo.robot.inertia_repair import missing_inertia, repair_inertia


def inertial(ixx, iyy, izz, ixy=0.0, ixz=0.0, iyz=0.0, mass=1.0, origin=Pose()):  # noqa: B008
    return Inertial(mass, origin, (ixx, ixy, ixz, iyy, iyz, izz))


def tensor(inertia):
    """Return the inertia matrix in the link's frame, shape (3, 3)."""
    w, x, y, z = inertia.quaternion
    axes = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    return axes @ np.diag(inertia.moments) @ axes.T


def test_possible_inertia_is_kept_to_the_digit():
    inertia = repair_inertia(inertial(0.02, 0.03, 0.04, 0.002, -0.001, 0.003))
    expected = [[0.02, 0.002, -0.001], [0.002, 0.03, 0.003], [-0.001, 0.003, 0.04]]
    assert tensor(inertia) == pytest.approx(np.array(expected))
    assert inertia.remarks == ()


def test_origin_turns_and_moves_the_inertia():
    origin = Pose((0.1, 0.2, 0.3), (0.0, 0.0, np.pi / 2))
    inertia = repair_inertia(inertial(0.02, 0.03, 0.04, origin=origin))
    assert tensor(inertia) == pytest.approx(np.diag([0.03, 0.02, 0.04]))
    assert inertia.position.tolist() == [0.1, 0.2, 0.3]


def test_a_violated_triangle_inequality_is_repaired_and_reported():
    inertia = repair_inertia(inertial(0.001, 0.001, 0.01))
    assert sorted(inertia.moments) == pytest.approx([0.005, 0.005, 0.01])
    assert (
        "0.01 kg m2 about one principal axis exceeds the sum about the other two"
        in inertia.remarks[0]
    )


def test_rounded_decimals_are_no_remark():
    inertia = repair_inertia(inertial(0.005, 0.0049999, 0.01))
    assert inertia.remarks == ()
    assert inertia.moments[0] + inertia.moments[1] >= inertia.moments[2]


@pytest.mark.parametrize("radius", [5e-3, 1e-3, 2e-5])
def test_what_a_rod_has_about_its_axis_is_kept(radius):
    across, along = 1.0 / 12, radius**2 / 2
    inertia = repair_inertia(inertial(across, across, along))
    assert sorted(inertia.moments) == pytest.approx([along, across, across], rel=1e-9, abs=0.0)
    assert inertia.remarks == ()


def test_decimals_of_a_rods_length_do_not_thicken_it():
    inertia = repair_inertia(inertial(0.3333, 0.3332, 1.25e-5))
    assert min(inertia.moments) == pytest.approx(1.25e-5, rel=1e-3)
    assert inertia.remarks == ()


def test_a_moment_that_is_missing_is_made_up():
    """The second one turned, where 0 comes out of the arithmetic as any tiny number."""
    for missing in (inertial(0.1, 0.1, 0.0), inertial(0.05, 0.05, 0.1, ixy=0.05)):
        assert min(repair_inertia(missing).moments) == pytest.approx(1e-4, rel=0.01)


def test_a_negative_moment_is_repaired_and_reported():
    inertia = repair_inertia(inertial(-0.01, 0.01, 0.01))
    assert inertia.moments.min() > 0
    assert "below 0 (-0.01 kg m2)" in inertia.remarks[0]


@pytest.mark.parametrize(
    "nonsense", [inertial(0.01, 0.01, 0.01, iyz=1e308), inertial(1e308, 1e308, 0.01, ixy=1e308)]
)
def test_moments_that_overflow_are_repaired_and_reported(nonsense):
    inertia = repair_inertia(nonsense)
    assert np.isfinite(inertia.moments).all()
    assert "its inertia is impossible" in inertia.remarks[-1]


def test_a_repaired_inertia_says_what_replaces_it():
    (remark,) = repair_inertia(inertial(1.0, 1.0, 3.0)).remarks
    assert remark.endswith("exceeds the sum about the other two; 1.5 1.5 3 kg m2 is used")


def test_a_zero_inertia_is_reported():
    inertia = repair_inertia(inertial(0, 0, 0))
    assert inertia.moments.tolist() == [1e-6] * 3
    assert "it has no inertia" in inertia.remarks[0]


def test_a_zero_mass_is_reported():
    inertia = repair_inertia(inertial(0.01, 0.01, 0.01, mass=0.0))
    assert inertia.mass == 1e-3
    assert "a mass of 0 kg is not above 0" in inertia.remarks[0]


def test_inertia_in_the_wrong_unit_is_used_with_a_warning():
    inertia = repair_inertia(inertial(1e8, 1e8, 1e8, mass=0.1))
    assert inertia.moments == pytest.approx([1e8] * 3)
    assert "as a mesh in millimetres taken for metres does" in inertia.remarks[0]


def test_a_light_body_with_too_much_inertia_is_not_called_a_mesh_in_millimetres():
    box = np.array([[-0.1, -0.1, -0.1], [0.1, 0.1, 0.1]])
    (remark,) = repair_inertia(inertial(0.1, 0.1, 0.1, mass=0.005), box).remarks
    assert "on 0.005 kg puts the mass 4.47 m from its centre; its bounding box's" in remark


def test_an_inertia_in_the_wrong_unit_is_replaced_from_the_shapes_if_there_are_any():
    box = np.array([[-0.1, -0.1, -0.1], [0.1, 0.1, 0.1]])
    inertia = repair_inertia(inertial(1e8, 1e8, 1e8, mass=0.1), box)
    assert inertia.moments == pytest.approx([0.1 * 0.2**2 / 6] * 3)
    assert "its bounding box's inertia is used" in inertia.remarks[0]


def test_the_inertia_of_a_huge_link_is_kept_if_it_fits_its_shapes():
    """1000 kg, most of it at the ends of 20 m."""
    box = np.array([[-10.0, -0.5, -0.5], [10.0, 0.5, 0.5]])
    inertia = repair_inertia(inertial(500, 9e4, 9e4, mass=1000.0), box)
    assert sorted(inertia.moments) == pytest.approx([500, 9e4, 9e4])
    assert inertia.remarks == ()


@pytest.mark.parametrize("moment", [4e-10, 1e-12, 1e-14])
def test_inertia_of_a_tiny_link_is_kept(moment):
    inertia = repair_inertia(inertial(moment, moment, moment, mass=1e-3))
    assert inertia.moments == pytest.approx([moment] * 3, abs=0.0)
    assert inertia.remarks == ()


def test_tiny_rod_is_one_that_mujoco_takes(parts):
    rod = (
        '<link name="rod"><inertial><mass value="1e-6"/><inertia ixx="1e-17" iyy="1e-14" '
        'izz="1e-14" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    )
    built = parts.build(parts.robot(parts.link("base"), rod, parts.joint("j", "base", "rod")))
    assert built.model.body("rod").inertia == pytest.approx([1e-14] * 3, abs=0.0)


def test_a_missing_mass_is_estimated_from_the_size():
    inertia = missing_inertia(np.array([[0, 0, 0], [0.1, 0.1, 1.0]]))
    assert inertia.mass == pytest.approx(3.0)
    assert inertia.position == pytest.approx([0.05, 0.05, 0.5])


def test_mere_frame_gets_next_to_nothing():
    inertia = missing_inertia(None)
    assert inertia.mass == 1e-3
    assert inertia.moments.tolist() == [1e-6] * 3


def test_links_are_repaired_in_a_model(parts):
    cube = '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'
    urdf = parts.robot(
        parts.link("base"),
        f'<link name="moving">{cube}</link>',
        '<link name="frame"/>',
        '<link name="tool"/>',
        parts.link("weight", 2.0),
        parts.joint("j", "base", "moving", xyz="0 0 1"),
        parts.joint("k", "moving", "frame"),
        parts.joint("l", "moving", "tool"),
        parts.joint("m", "tool", "weight", "fixed"),
    )
    built = parts.build(urdf)
    assert built.model.body("moving").mass[0] == pytest.approx(0.3)
    assert built.model.body("frame").mass[0] == pytest.approx(1e-3)
    # What is fixed to it gives the tool its mass.
    assert built.model.body("tool").mass[0] == 0
    remarks = [str(finding) for finding in built.report.warnings]
    assert [remark.partition(" (")[0] for remark in remarks] == ["link 'moving'", "link 'frame'"]
