"""Parses XML safely: no entities, no network, bounded size; keeps line numbers."""

import re

import lxml.etree as etree

from arm_description.errors import XmlError

MAX_BYTES = 20_000_000

UNDECLARED = "undeclared:"
"""Start of the namespace for a prefix that the text uses without declaring it."""
MAX_PREFIXES = 50
"""How many missing prefixes are declared."""

_UNDECLARED = re.compile(r"Namespace prefix (\S+) (?:for \S+ )?on \S+ is not defined")
_FIRST_TAG = re.compile(rb"(?:\s+|<!--.*?-->|<\?.*?\?>)*<[^\s/>!?]+", re.DOTALL)
_DECLARATION = re.compile(r"\A\ufeff?\s*(<\?xml\s[^>]*\?>)?\s*")
_POSITION = re.compile(r"(, line \d+, column \d+)+\Z")


def parse_xml(text: str, source: str = "robot_description") -> etree._Element:
    """Parse XML and return its root element, or the only <robot> in a <urdf>.

    See `parse_document`.
    """
    return unwrapped(parse_document(text, source))


def parse_document(text: str, source: str = "robot_description") -> etree._Element:
    """Parse XML and return its root element; comments and processing instructions are dropped.

    Elements without a prefix are in no namespace, even if the document declares a default one as
    urdf.xsd does. Elements with a prefix keep its namespace; an undeclared prefix, which ROS's own
    parser accepts because it does not know namespaces, gets one that begins with `UNDECLARED`.

    Args:
        text: the document. The encoding in its declaration is ignored; blanks before the
            declaration are allowed, as in a YAML file's block text.
        source: name of the text in messages.

    Raises:
        XmlError: the text is not well-formed, larger than 20 MB, or has a DOCTYPE (whose entities
            could expand without bound or read files). The message names source and line.
    """
    # Remove the declaration but keep its line breaks, so that line numbers stay the same.
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
        root = _parsed(data)
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


def unwrapped(root: etree._Element) -> etree._Element:
    """Return the only <robot> in a <urdf>; any other root unchanged."""
    inner = list(root.iterchildren("*"))
    if root.tag != "urdf" or len(inner) != 1 or inner[0].tag != "robot":
        return root
    root.remove(inner[0])
    return inner[0]


def is_foreign(element: etree._Element) -> bool:
    """Return whether an element has an undeclared prefix or xacro's."""
    namespace = etree.QName(element).namespace or ""
    return element.prefix == "xacro" or namespace.startswith(UNDECLARED)


def _parsed(data: bytes) -> etree._Element:
    """Parse a document, declaring its undeclared prefixes."""
    for _ in range(MAX_PREFIXES):
        try:
            return etree.fromstring(data, _parser())
        except etree.XMLSyntaxError as error:
            missing = _UNDECLARED.match(error.msg)
            first = _FIRST_TAG.match(data)
            if missing is None or first is None:
                raise
            prefix = missing.group(1)
            declaration = f' xmlns:{prefix}="{UNDECLARED}{prefix}"'.encode()
            data = data[: first.end()] + declaration + data[first.end() :]
    return etree.fromstring(data, _parser())


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
