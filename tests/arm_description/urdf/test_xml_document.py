"""Safe XML: what is refused, and the line numbers in messages."""

import pytest

from arm_description import XmlError, parse_xml
from arm_description.urdf.xml_document import MAX_BYTES


def test_the_root_element_is_returned():
    assert parse_xml("<robot name='a'/>").get("name") == "a"


def test_lines_are_those_of_the_text_even_behind_blanks_and_a_declaration():
    root = parse_xml('\n\n  <?xml version="1.0"?>\n\n<robot>\n  <link/>\n</robot>\n')
    assert root.sourceline == 5
    assert root[0].sourceline == 6


def test_a_declaration_of_another_encoding_means_nothing_for_text():
    root = parse_xml("<?xml version='1.0' encoding='latin-1'?><robot name='è'/>")
    assert root.get("name") == "è"


def test_a_byte_order_mark_is_ignored():
    assert parse_xml("\ufeff<?xml version='1.0'?><robot/>").tag == "robot"


def test_comments_and_processing_instructions_are_dropped():
    assert len(parse_xml("<robot><!-- a --><?b c?></robot>")) == 0


def test_a_namespace_for_all_makes_no_other_elements():
    root = parse_xml("<robot xmlns='http://www.ros.org' xmlns:y='y'><link/><y:link/></robot>")
    assert [element.tag for element in root.iter()] == ["robot", "link", "{y}link"]


@pytest.mark.parametrize("text", ["", " \n\t", "<?xml version='1.0'?>\n"])
def test_an_empty_text_is_reported_as_empty(text):
    with pytest.raises(XmlError, match=r"^arm\.urdf is empty$"):
        parse_xml(text, "arm.urdf")


def test_an_error_names_source_and_line():
    with pytest.raises(XmlError, match=r"^arm\.urdf, line 3: not XML: .*mismatch"):
        parse_xml("<robot>\n<link>\n</joint></robot>", "arm.urdf")


@pytest.mark.parametrize(
    "text",
    [
        "<!DOCTYPE robot><robot/>",
        "<!DOCTYPE r [<!ENTITY a 'b'>]><robot name='&a;'/>",
        "<!DOCTYPE r [<!ENTITY a SYSTEM 'file:///etc/passwd'>]><robot>&a;</robot>",
    ],
)
def test_a_doctype_is_refused(text):
    with pytest.raises(XmlError, match="DOCTYPE"):
        parse_xml(text)


def test_entities_of_entities_are_refused():
    entities = "<!ENTITY a 'x'><!ENTITY b '&a;&a;'>"
    with pytest.raises(XmlError, match="DOCTYPE"):
        parse_xml(f"<!DOCTYPE r [{entities}]><robot name='&b;'/>")


def test_a_text_too_large_is_refused():
    with pytest.raises(XmlError, match="20000000"):
        parse_xml(f"<robot>{' ' * MAX_BYTES}</robot>")


def test_half_a_character_is_refused_with_its_line():
    with pytest.raises(XmlError, match="line 2: a character that is not Unicode"):
        parse_xml("<robot>\n\ud800</robot>")


def test_a_null_character_is_refused():
    with pytest.raises(XmlError):
        parse_xml("<robot>\x00</robot>")
