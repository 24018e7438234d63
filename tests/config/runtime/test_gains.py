"""Gains from a file of settings, and in the settings of a session; what a bundle repeats of a verification."""

import json

import pytest
from config.runtime.bundles import example

from contactbench.pipeline.config.runtime import ConfigError
from contactbench.pipeline.config.runtime.checks import read_verification
from contactbench.pipeline.config.runtime.options import ExportOptions, controller_in


def test_a_controller_is_read_from_a_file_of_settings():
    part = example().model.controller
    data = json.dumps({"controller": part.model_dump(), "limits": None}).encode()
    assert controller_in(data, "gains.json") == part
    for wrong, words in (
        (b"{}", "gains.json: it contains no controller"),
        (b"x", "not valid JSON"),
        (b'{"controller":{"variant":"bold"}}', "gains.json: controller.variant is 'bold'"),
        (b" " * (2**20 + 1), "larger than 1 MiB"),
    ):
        with pytest.raises(ConfigError, match=words):
            controller_in(wrong, "gains.json")


def test_a_wrong_controller_of_a_session_is_named():
    wrong = example().model.controller.model_dump()
    wrong["angle"]["gain_per_s"][1] = -1.0
    with pytest.raises(ConfigError, match=r"config\.controller\.angle\.gain_per_s\.1"):
        ExportOptions.checked({"controller": wrong})


def verification(**settings):
    figures = {f"{name}_mm": 0.3 for name in ("mean", "sd", "p95", "max")}
    content = {
        "schema": "contactbench.verification",
        "version": 1,
        "overall": {"touches": 10, **figures},
        "per_marker": [{}] * 5,
        "ratio": 1.0,
        "times": None,
        "verdict": {"passed": True, "reasons": []},
        "diagnosis": None,
        "limits": {"mean_m": 0.001, "max_m": 0.002},
        "settings": settings,
    }
    return json.dumps(content).encode()


def test_markers_that_were_left_out_are_repeated_with_why():
    part, _ = read_verification(verification(left_out={"7": "nothing reaches it"}), "v.json")
    assert part.diagnosis.startswith("Skipped on purpose: 7 (nothing reaches it): contacts")
    for none in ({}, {"left_out": {}}, {"left_out": None}):
        part, _ = read_verification(verification(**none), "v.json")
        assert "Skipped" not in part.diagnosis
