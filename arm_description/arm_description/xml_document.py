"""XML text to elements, safely: no entities, no network, bounded size, line numbers kept."""

import re

import lxml.etree as etree

from arm_description.errors import XmlError

MAX_BYTES = 20_000_000

_DECLARATION = re.compile(r"\A\ufeff?\s*(<\?xml\s[^>]*\?>)?\s*")
_POSITION = re.compile(r"(, line \d+, column \d+)+\Z")


def parse_xml(text: str, source: str = "robot_description") -> etree._Element:
    """Parse XML and return its root element; comments and processing instructions are dropped.

    What has no prefix is in no namespace either: whoever declares one for all, as urdf.xsd has
    it for a robot, means the same elements. Those with a prefix keep theirs.

    Args:
        text: the document. What its declaration says of the encoding is ignored, blanks before
            the declaration are allowed, as in a YAML file's block text.
        source: what the text is called in messages.

    Raises:
        XmlError: not well-formed, over 20 MB, or with a DOCTYPE (the door to entities that
            expand without bound or read files). The message names source and line.
    """
    # The declaration goes, its line breaks stay: the line numbers are the author's.
    body = _DECLARATION.sub(lambda match: "\n" * match.group().count("\n"), text, count=1)
    if not body.strip():
        raise XmlError(f"{source} is empty")
    try:
        data = body.encode("utf-8")
    except UnicodeEncodeError as error:
        line = 1 + body.count("\n", 0, error.start)
        raise XmlError(f"{source}, line {line}: a character that is not Unicode") from error
    if len(data) > MAX_BYTES:
        raise XmlError(f"{source} has {len(data)} bytes; at most {MAX_BYTES} are accepted")
    try:
        root = etree.fromstring(data, _parser())
    except etree.XMLSyntaxError as error:
        problem = _POSITION.sub("", error.msg)
        raise XmlError(f"{source}, line {error.lineno or 1}: not XML: {problem}") from error
    if root.getroottree().docinfo.internalDTD is not None:
        raise XmlError(f"{source} has a DOCTYPE, which is not accepted; remove it")
    for element in root.iter("*"):
        if element.prefix is None:
            element.tag = etree.QName(element).localname
    etree.cleanup_namespaces(root)
    return root


def _parser() -> etree.XMLParser:
    return etree.XMLParser(
        encoding="utf-8",
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
    )
