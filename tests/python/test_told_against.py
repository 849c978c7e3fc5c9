"""What `experiments/told_against.py` makes of deviations, against values that are known."""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "experiments"))
import told_against as told  # noqa: E402


def test_equal_values_share_their_rank():
    assert told.ranks(np.array([3.0, 1.0, 3.0, 2.0])).tolist() == [3.5, 1.0, 3.5, 2.0]


def test_rank_correlations_are_of_pairs_that_were_flown_by_both():
    one = np.linspace(1.0, 2.0, 30)
    assert told.rank_correlation(one, np.exp(one)) == "1.00 (1.00 to 1.00)"
    other = -one
    other[0] = np.nan
    assert told.rank_correlation(one, other) == "-1.00 (-1.00 to -1.00)"


def test_a_lift_is_the_ratio_of_geometric_means():
    assert told.lift(np.array([2.0, 8.0, np.nan]), np.array([2.0, 2.0])).startswith("+100 (0 to 300)")


def test_ends_are_counted():
    assert told.ends(["done", "crash", "time", "time"]) == "1, 2"
    assert told.ends(["done", None]) == "0, 0, 1 not flown"
