"""The first page of a report: complete, whole, on one sheet, and with numbers that agree with one another."""

import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest
from benchmarks.verification import bench
from report.report_cases import CREATED
from weighing_files import weighed

from contactbench.pipeline.calibration import calibrate
from contactbench.pipeline.calibration.files.calibration_file import load_record, save_calibration
from contactbench.pipeline.calibration.report.page import report_html as calibration_html
from contactbench.pipeline.mesh.regions.region import RegionSet
from contactbench.pipeline.mesh.sidecar import ProbeFile
from contactbench.pipeline.page import APPENDIX, print_pdf
from contactbench.pipeline.page.details import ReportDetails
from contactbench.pipeline.report import ReportContent, report_html
from contactbench.pipeline.report.figures import draw
from contactbench.pipeline.report.picture import marker_views
from contactbench.pipeline.verification.verify import verify

DETAILS = ReportDetails("A. Technician", "M8128", "DKD-K-7", "2026-12-31", {"sensor": "SN 7"})
LONG = "Dipl.-Ing. Friedrich-Wilhelm Oberhuber-Schmidt von der Donaudampfschifffahrtsgesellschaft, Nürnberg"
UNITS = "mm|µm|N|mN·m|N·m|kg|g|ms|µs|s|Hz|%|×|sigma|UTC"


@pytest.fixture(scope="module")
def record(tmp_path_factory):
    file = tmp_path_factory.mktemp("calibration") / "c.json"
    save_calibration(calibrate(weighed().poses), file, created=CREATED)
    return load_record(file)


@pytest.fixture(scope="module")
def given(record):
    found = bench(None, np.random.default_rng(5))
    model = replace(found.model, covariance=record.calibration.covariance)
    verified = verify(found.probe, model, found.markers, found.recording, mesh_deviation=4e-5)
    file = ProbeFile(found.probe, RegionSet.from_labels(found.probe.region, []), "S")
    return ReportContent(verified, file, record, CREATED, DETAILS, "bench 3")


@pytest.fixture(scope="module")
def verified_page(given):
    return report_html(given)


@pytest.fixture(scope="module")
def calibrated_page(record):
    return calibration_html(record.calibration, created=CREATED, details=DETAILS)


class Cells(HTMLParser):
    """Collects the rows of the tables of one class."""

    def __init__(self, page, kind):
        super().__init__()
        self.kind, self.rows, self.inside, self.cell = kind, [], False, False
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        if tag == "table":
            self.inside = self.kind in dict(attributes).get("class", "").split()
        if self.inside and tag == "tr":
            self.rows.append([])
        if self.inside and tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        self.inside = self.inside and tag != "table"

    def handle_data(self, data):
        if self.inside and self.rows and self.rows[-1]:
            self.rows[-1][-1] += data


def text_of(page):
    return " ".join(re.sub(r"<style.*?</style>|<[^>]+>", " ", page, flags=re.DOTALL).split())


def contributions(page):
    """Contributions by source, as they stand on the page, mm; the last two are u_c and U."""
    rows = [[cell.strip() for cell in row] for row in Cells(page, "budget").rows[1:]]
    return {
        row[0]: float(row[-1].removesuffix("\u00a0mm").replace("\N{MINUS SIGN}", "-"))
        for row in rows
        if row[-1].endswith("mm")
    }


@pytest.mark.parametrize("name", ["verified_page", "calibrated_page"])
def test_the_contributions_on_the_page_add_up(name, request):
    *parts, u, U = contributions(request.getfixturevalue(name)).values()
    rounding = 0.0005 * (1 + 2 * sum(abs(part) for part in parts) / u)
    assert u == pytest.approx(np.sqrt(sum(np.sign(p) * p * p for p in parts)), abs=rounding)
    assert pytest.approx(2 * u, abs=0.0011) == U
    assert len(parts) >= 5


def test_a_contribution_that_is_changed_shows_in_the_sum(given, verified_page):
    first, *others = given.verification.budget
    more = replace(first, variance_mm2=first.variance_mm2 + 1.0)
    changed = replace(given, verification=replace(given.verification, budget=(more, *others)))
    before, after = contributions(verified_page), contributions(report_html(changed))
    differing = [name for name in before if before[name] != after[name]]
    assert differing[0] == "Noise of the force"
    assert len(differing) == 3  # this one, u_c and U
    u = list(after.values())[-2]
    assert u**2 == pytest.approx(list(before.values())[-2] ** 2 + 1, rel=2e-3)


def test_the_first_page_says_who_what_when_and_with_which_sensor(verified_page, calibrated_page):
    for page in (verified_page, calibrated_page):
        text = text_of(page.partition(APPENDIX)[0])
        for words in ("A. Technician", "M8128", "SN 7", "DKD-K-7", "2026-12-31", "2026-03-04 05:06 UTC"):
            assert words in text
        assert text.endswith("Name Date Signature")
        assert "not given" not in text.replace("Poses from not given", "")


def test_what_is_missing_is_said_with_where_it_is_given(record):
    text = text_of(calibration_html(record.calibration, details=ReportDetails(operator="A. B.")))
    assert "Serial number not given" in text
    assert "add --sensor , --serial , --certificate , --due to the command" in text
    assert "report.sensor , devices.serial , report.certificate , report.due once" in text
    assert "--operator" not in text


def test_a_sensor_calibration_that_is_overdue_is_told(given, record):
    late = replace(DETAILS, due="2026-03-03")
    words = "calibration was due on 2026-03-03, before this report"
    assert words in text_of(report_html(replace(given, details=late)))
    assert words in text_of(calibration_html(record.calibration, created=CREATED, details=late))
    assert "was due" not in text_of(report_html(replace(given, details=replace(late, due="2026-03-04"))))


def test_both_reports_say_the_same_of_the_calibration(record, verified_page, calibrated_page):
    both = [text_of(page) for page in (verified_page, calibrated_page)]
    share = re.search(r"It adds at most (\S+ mm) \(1 sigma, worst case\)", both[0])[1]
    assert f"{share} What this calibration adds to the error of a contact" in both[1]
    assert contributions(calibrated_page).popitem()[1] == pytest.approx(
        2e3 * record.calibration.contact_error, abs=6e-4
    )
    for name in ("centre of mass", "force", "torque"):
        shown = re.search(rf"{name}[a-z ]*, m?N?·?m?m?N? (\S+ ± \S+)", both[0])
        assert shown
        assert shown[1] in both[1]


def test_errors_beyond_the_budget_and_budgets_beyond_the_limit_are_told(given):
    v = given.verification
    far = replace(v, overall=replace(v.overall, rms_mm=3 * v.combined_mm))
    assert "That is more than the budget explains" in text_of(report_html(replace(given, verification=far)))
    assert "more than the budget explains" not in text_of(report_html(given))
    first, *others = v.budget
    wide = replace(v, budget=(replace(first, variance_mm2=4.0), *others))
    assert "U is more than the limit of the largest error, 2 mm" in text_of(
        report_html(replace(given, verification=wide))
    )


def test_colours_follow_the_limits_not_the_largest_value(given):
    v = given.verification
    accepted = [touch for touch in v.touches if touch.accepted]
    views = marker_views(accepted, given.probe.probe)
    within = draw(accepted, v.per_marker, views, v.limits, None)
    strict = replace(v.limits, mean_m=1e-6, max_m=2e-6)
    beyond = draw(accepted, v.per_marker, views, strict, None)
    for kept, broken in ((within.markers, beyond.markers), (within.scatter[0], beyond.scatter[0])):
        assert "var(--torque)" not in kept
        assert "var(--torque)" in broken
    assert "over its limit" in beyond.markers
    numbers = re.compile(r'<b class="over">(.*?)</b>')
    assert numbers.findall(report_html(given)) == []
    failed = report_html(replace(given, verification=replace(v, limits=strict)))
    assert len(numbers.findall(failed)) == 2
    assert ">0.002<" in failed or "largest error; the limit is 0.002" in text_of(failed)


@pytest.mark.parametrize("name", ["verified_page", "calibrated_page"])
def test_a_unit_never_stands_on_another_line_than_its_number(name, request):
    page = re.sub(r"<style.*?</style>", "", request.getfixturevalue(name), flags=re.DOTALL)
    assert re.findall(rf">[^<]*\d (?:{UNITS})(?![\w·])[^<]*<", page) == []
    assert len(re.findall(rf"\d\u00a0(?:{UNITS})", page)) > 20
    for cell in re.findall(r"<td[^>]*>[^<]*\u00a0(?:mm|N|mN·m)\b", page.partition("Uncertainty budget")[2]):
        assert "number" in cell or "±" in cell or "facts" not in cell


def test_the_first_page_is_one_sheet(given, calibrated_page):
    weasyprint = pytest.importorskip("weasyprint")
    v = given.verification
    reasons = tuple(
        f"the mean error is {1000 + n}.25 mm, over 1 mm, and so on for reason {n}" for n in range(9)
    )
    crowded = replace(
        given,
        details=replace(DETAILS, operator=LONG, certificate=LONG, due="2026-01-01"),
        verification=replace(v, verdict=replace(v.verdict, passed=False, reasons=reasons)),
    )
    pages = [report_html(crowded), calibrated_page]
    printed = []
    with pytest.MonkeyPatch.context() as patch:
        real = weasyprint.HTML.write_pdf

        def keep(self, *args, **more):
            printed.append(self.render())
            return real(self, *args, **more)

        patch.setattr(weasyprint.HTML, "write_pdf", keep)
        for page in pages:
            assert print_pdf(page).startswith(b"%PDF")
    assert len(printed) == 2
    for document in printed:
        places = [number for number, page in enumerate(document.pages) if "appendix" in page.anchors]
        assert places == [1]
        width, height = document.pages[0].width, document.pages[0].height
        assert (round(width * 25.4 / 96), round(height * 25.4 / 96)) == (210, 297)
    text = text_of(pages[0])
    assert "5 more below, under “All reasons”." in text
    assert text.count("reason 8.") == 1
