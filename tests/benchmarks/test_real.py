import pytest
from benchmarks.real import RECORDINGS, run

from contactbench.pipeline.errors import InputError


@pytest.mark.skipif(not RECORDINGS.is_dir(), reason=f"the recordings of others are not at {RECORDINGS}")
def test_recordings_of_others_keep_the_figures_of_their_page():
    report = run()
    assert report.passed, report.markdown()
    assert {row[4].split()[0] for row in report.sheets[0].rows} == {"drift", "channel", "crosstalk"}


def test_a_folder_without_recordings_is_refused(tmp_path):
    with pytest.raises(InputError, match="there are no recordings here"):
        run(folder=tmp_path)
