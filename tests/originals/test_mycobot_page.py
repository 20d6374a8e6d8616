"""The page of the myCobot and the ROSMASTER X3, from its first line to its last."""

import pytest
from walk import rows_of

pytestmark = [pytest.mark.ros, pytest.mark.slow, pytest.mark.timeout(600)]


@pytest.mark.parametrize(
    ("page", "row"),
    [pytest.param(page, row, id=f"{page}-{row.name}") for page, row in rows_of("S4")],
)
def test_a_row_comes_as_the_table_says(walk, page, row):
    walk.assert_row(page, row)
