"""A session that the version 1 wrote, as it was: checked, packed and unpacked before anything migrates it."""

from __future__ import annotations

import base64

import pytest

from contactbench.pipeline.session import Session
from contactbench.pipeline.session.actions import VERSION
from contactbench.pipeline.session.archive import export_archive, import_archive
from contactbench.pipeline.session.check import check

ARCHIVE = base64.b64decode(
    "UEsDBBQAAAAIAAAAIQCe6MSJuAEAAHgCAAAHAAAAam91cm5hbKWQvWsUQRjGV0h6IVoKMiomcW+dj/2YXStjlWAXy8Dx7sxsbvFu"
    "59idJMTj0ghWEosIIRCS0iaQNiSBaKOCpLC10SY2KfQPsHAmfhAtbISBGd7nmed5+a3dm5r54nneu2srJ5MfJ4cf1rdPvk4dzF2+"
    "eeeZf2Xz0+Dp6Vt9cfw4u3R3Zuvz6d4AgTClrlA2QKVEGYpFolLGgPBcYUyTFEeERVLmRcq4DAnyUa+cr8Eo2S5q3UNZtdDt+qgR"
    "HdWD9lmG0JWxsbmqRCdoVNO4Ah+Z5b6y6s9BW9TKpVhhUdVnlowMfQTGeiimcYuQFiUPKMvciQPGwiiKbmGcYWw/5cvWV2tt7LtR"
    "VaPrX6sYrbt/bXEVByTAaLhm8Uxc8LwXj8uRiePnY/ent9+PjZCV/bml0Z3XGy+fvNnFN1aPVq/Pzx6+Otj/dh5PUXaVu/tgOq4a"
    "lm4nTOSMRxxinrQgEM2iW6YDNIqt47wKPExDAYxRhiOGSUw5LZgEyVIZUlHEVECoklRKoAAikSkIl1U+sp3UYnlYVg5tX1t8Vqig"
    "51j+7vwTwA/QZdVfMG2Q0kL+N1gecvp/YL8DUEsDBC0AAAAIAAAAIQAfCOpG//////////8WABQAcmF3LzczY2IzODU4YTY4Ny1h"
    "LmNzdgEAEAACAAAAAAAAAAQAAAAAAAAAq+ACAFBLAQIUAxQAAAAIAAAAIQCe6MSJuAEAAHgCAAAHAAAAAAAAAAAAAACkgQAAAABq"
    "b3VybmFsUEsBAi0DLQAAAAgAAAAhAB8I6kYEAAAAAgAAABYAAAAAAAAAAAAAAKSB3QEAAHJhdy83M2NiMzg1OGE2ODctYS5jc3ZQ"
    "SwUGAAAAAAIAAgB5AAAAKQIAAAAA"
)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "old.zip").write_bytes(ARCHIVE)
    import_archive(tmp_path / "old.zip", tmp_path / "s")
    return tmp_path / "s"


def test_an_old_session_is_sound_and_stays_old_until_it_is_written(folder):
    data = (folder / "journal").read_bytes()
    assert b'"version":1' in data
    found = check(folder)
    assert found.problems == ()
    assert "older version 1" in found.notes[0]
    assert (folder / "journal").read_bytes() == data


def test_it_is_packed_as_it_is(folder, tmp_path):
    done = export_archive(folder, tmp_path / "again.zip")
    assert done.files == 2
    assert "older version 1" in done.notes[0]
    import_archive(tmp_path / "again.zip", tmp_path / "back")
    assert (tmp_path / "back" / "journal").read_bytes() == (folder / "journal").read_bytes()


def test_once_migrated_its_first_journal_goes_with_it(folder, tmp_path):
    with Session.open(folder) as session:
        assert session.records[0].action.version == VERSION
        session.note("after")
    assert check(folder).problems == ()
    assert export_archive(folder, tmp_path / "new.zip").files == 3
    import_archive(tmp_path / "new.zip", tmp_path / "back")
    assert (tmp_path / "back" / "journal.v1").exists()
