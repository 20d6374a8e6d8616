"""The page of the myCobot and the ROSMASTER X3, from its first line to its last."""

import pytest
from originals_table import Row
from walk import Walk, rows_of

pytestmark = [pytest.mark.ros, pytest.mark.slow, pytest.mark.timeout(600)]


@pytest.mark.parametrize(
    ("page", "row"),
    [pytest.param(page, row, id=f"{page}-{row.name}") for page, row in rows_of("S4")],
)
def test_a_row_comes_as_the_table_says(walk: Walk, page: str, row: Row):
    walk.assert_row(page, row)
