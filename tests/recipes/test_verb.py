"""The recipe for a verb of `arm`: `arm bag size`, which says how large a bag is."""

from checkout import Checkout

VERB = '''\
"""`arm bag size`: how many bytes the recordings of a bag have."""

import argparse
from pathlib import Path

from arm_cli.arguments import JSON, Argument, verb
from arm_cli.errors import NoSuchNameError
from arm_cli.output import print_json, say


@verb(Argument("bag", type=Path, help="folder of the bag"), JSON)
def size(options: argparse.Namespace) -> None:
    """Print the size."""
    files = list(options.bag.glob("*.mcap"))
    if not files:
        raise NoSuchNameError(f"{options.bag} has no recording")
    size = sum(file.stat().st_size for file in files)
    if options.json:
        print_json(size)
    else:
        say(f"{size} bytes")
'''
LAST_ROW = 'Verb("list", "list the supported bag formats", "bag.info:list_plugins"),'
ROW = 'Verb("size", "show how large a bag is", "bag.size"),'


def test_a_verb_is_added_through_the_files_of_its_recipe(tmp_path):
    checkout = Checkout(tmp_path, "A verb of arm", GROUP="bag", NAME="size")
    checkout.write("arm_cli/arm_cli/bag/size.py", VERB)
    checkout.insert("arm_cli/arm_cli/verbs.py", (LAST_ROW, f"{LAST_ROW}\n        {ROW}"))
    bag = tmp_path / "run1"
    bag.mkdir()
    (bag / "run1_0.mcap").write_bytes(bytes(42))

    assert checkout.run_module("arm_cli", "bag", "size", str(bag)) == "42 bytes\n"
    assert checkout.run_module("arm_cli", "bag", "size", str(bag), "--json") == "42\n"
    assert "size     show how large a bag is" in checkout.run_module("arm_cli", "bag", "--help")
