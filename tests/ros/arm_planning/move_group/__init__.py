"""Tests of one `move_group`: the files of this folder share its launch, see `launched`."""
