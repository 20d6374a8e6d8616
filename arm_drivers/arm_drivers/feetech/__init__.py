"""Feetech's STS servos on one serial bus, as in the SO-101."""
