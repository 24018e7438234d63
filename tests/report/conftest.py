import pytest


@pytest.fixture(scope="module", autouse=True)
def _small_pictures():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("contactbench.pipeline.report.page._PIXELS", 60)
        yield
