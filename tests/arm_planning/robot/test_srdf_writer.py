from hypothesis import given
from hypothesis import strategies as st
from robots import joint, link, robot

from arm_description import parse_urdf
from arm_planning.robot.srdf import EndEffector, Srdf, SrdfGroup, VirtualJoint, parse_srdf
from arm_planning.robot.srdf_writer import srdf_text

ODD = "l<\"&'>"
XML = {"'": "&apos;", "<": "&lt;", '"': "&quot;", "&": "&amp;"}
ESCAPED = "".join(XML.get(letter, letter) for letter in ODD)
ROBOT = parse_urdf(
    robot(
        *(link(name) for name in ("a", "b", ESCAPED)),
        joint("i", "a", "b"),
        joint("j", "b", ESCAPED),
        joint("free", "a", "c", kind="floating", limits=None),
        link("c"),
    )
)
LINKS, JOINTS = st.sampled_from(["a", "b", ODD]), st.sampled_from(["i", "j"])
PAIRS = st.tuples(LINKS, LINKS).map(lambda pair: (min(pair), max(pair)))
NUMBERS = st.floats(allow_nan=False, allow_infinity=False)
GROUPS = st.builds(
    SrdfGroup,
    st.lists(JOINTS, max_size=2).map(tuple),
    st.lists(LINKS, max_size=2).map(tuple),
    st.lists(st.tuples(LINKS, LINKS), max_size=2).map(tuple),
)
SRDFS = st.builds(
    Srdf,
    st.sampled_from(["r", ODD]),
    groups=st.fixed_dictionaries({"g": GROUPS, ODD: st.just(SrdfGroup(subgroups=("g",)))}),
    states=st.dictionaries(
        st.tuples(st.sampled_from(["g", ODD]), st.sampled_from(["home", ODD])),
        st.fixed_dictionaries(
            {}, optional={"i": st.tuples(NUMBERS), "free": st.tuples(NUMBERS, NUMBERS)}
        ),
    ),
    end_effectors=st.dictionaries(
        st.just("e"), st.builds(EndEffector, LINKS, st.just("g"), st.sampled_from(["", ODD]))
    ),
    virtual_joints=st.sampled_from([(), (VirtualJoint("v", "planar", ODD, "a"),)]),
    passive_joints=st.lists(JOINTS, max_size=2).map(tuple),
    disabled=st.dictionaries(PAIRS, st.sampled_from(["Never", "", ODD])),
    enabled=st.lists(PAIRS, unique=True).map(tuple),
    touching=st.lists(LINKS, max_size=2).map(tuple),
    properties=st.dictionaries(st.tuples(JOINTS, st.just("p")), st.sampled_from(["1", ODD])),
)


@given(SRDFS)
def test_what_is_written_is_read_again(srdf: Srdf):
    assert parse_srdf(srdf_text(srdf), ROBOT, remark=lambda _: None) == srdf
