"""The main job on the bundled probes, without hardware: simulate, locate, compare with the truth, draw."""

from contactbench.assets import PROBE_NAMES
from contactbench.pipeline.demo.bench import DemoReport, ProbeResult, run

__all__ = ["PROBE_NAMES", "DemoReport", "ProbeResult", "run"]
