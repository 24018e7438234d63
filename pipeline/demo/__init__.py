"""The main job on the bundled probes, without hardware: simulate, locate, compare with the truth, draw."""

from assets import PROBE_NAMES
from pipeline.demo.bench import run
from pipeline.demo.report import DemoReport, ProbeResult

__all__ = ["PROBE_NAMES", "DemoReport", "ProbeResult", "run"]
