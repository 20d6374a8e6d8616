"""The pages of the 4-DOF arm, each from its first line to its last."""

import pytest
from walk import rows_of

pytestmark = [pytest.mark.ros, pytest.mark.slow, pytest.mark.timeout(600)]


@pytest.mark.parametrize(
    ("page", "row"),
    [
        pytest.param(page, row, id=f"{page}-{row.name}")
        for page, row in rows_of("S0", "S1", "S2", "S3")
    ],
)
def test_a_row_comes_as_the_table_says(walk, page, row):
    walk.assert_row(page, row)
