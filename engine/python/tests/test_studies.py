"""Single rows of a study: the same bytes whenever they are asked for, and bad input by name."""

import pytest

import toile

STUDY = """
name = "Tee"
seed = 3
[[garment]]
name = "tee"
sizes = ["38", "40"]
[population]
from = "ansur"
people = 5
women = 1.0
"""


@pytest.fixture
def study(tmp_path):
    path = tmp_path / "tee.toml"
    path.write_text(STUDY)
    return path


def test_a_row_is_the_same_parquet_file_whatever_was_asked_for_before(study):
    first = toile.study_row(study, 7)
    assert first[:4] == b"PAR1" and first[-4:] == b"PAR1"
    assert toile.study_row(str(study), 2) != first
    assert toile.study_row(study, 7) == first


@pytest.mark.parametrize("index, error", [(10, toile.InputError), (-1, toile.UsageError)])
def test_a_row_that_there_is_not_is_refused(study, index, error):
    with pytest.raises(error, match=str(abs(index))):
        toile.study_row(study, index)


def test_what_is_no_study_is_refused_by_name(tmp_path):
    with pytest.raises(toile.InputError, match="no-such.toml"):
        toile.study_row(tmp_path / "no-such.toml", 0)
    with pytest.raises(toile.UsageError, match="NoneType"):
        toile.study_row(None, 0)
