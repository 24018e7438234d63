"""A verification as a page for people, and as a PDF."""

from contactbench.pipeline.report.page import ReportContent, report_html
from contactbench.pipeline.report.report_file import read_verification

__all__ = ["ReportContent", "read_verification", "report_html"]
