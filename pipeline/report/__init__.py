"""A verification as a page for people, and as a PDF."""

from contactbench.pipeline.report.page import ReportContent, ReportError, report_html
from contactbench.pipeline.report.pdf import report_pdf
from contactbench.pipeline.report.reading import read_verification

__all__ = ["ReportContent", "ReportError", "read_verification", "report_html", "report_pdf"]
