"""
Time the C library's update on a probe of 20,000 facets, beside one ray of Embree in the same run.

Example: python tests/kernel/bench_runtime.py build/runtime/contactbench-bench
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
from config.runtime.bundles import example_bundle
from kernel.runtime_cases import stream


def embree_nanoseconds(vertices: np.ndarray, faces: np.ndarray, rays: int = 20_000) -> float | None:
    """Return the median time of one ray, called from Python; None without embreex."""
    try:
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene
    except ImportError:
        return None
    scene = EmbreeScene()
    TriangleMesh(scene, vertices[faces].astype(np.float32))
    rng = np.random.default_rng(1)
    start = rng.normal(size=(rays, 3))
    start *= (0.5 / np.linalg.norm(start, axis=1))[:, None]
    aim = vertices[faces[rng.integers(0, len(faces), rays)]].mean(axis=1) - start
    pairs = [
        (s[None].astype(np.float32), a[None].astype(np.float32)) for s, a in zip(start, aim, strict=True)
    ]
    times = []
    for origin, direction in pairs:
        before = time.perf_counter_ns()
        scene.run(origin, direction)
        times.append(time.perf_counter_ns() - before)
    return float(np.median(times))


def main(bench: str, facets: int = 20_000, count: int = 200_000) -> None:
    """Print one JSON object."""
    with tempfile.TemporaryDirectory() as folder:
        bundle, samples = Path(folder) / "bundle", Path(folder) / "samples"
        config = example_bundle(bundle, facets)
        readings, R, times = stream(config, count)
        samples.write_bytes(np.column_stack([times, readings, R.reshape(-1, 9)]).tobytes())
        done = subprocess.run([bench, bundle, samples], capture_output=True, text=True, check=True)
        figures = json.loads(done.stdout)
        figures["facets"] = len(config.probe.faces)
        figures["embree_ns"] = embree_nanoseconds(config.probe.vertices, config.probe.faces)
    sys.stdout.write(json.dumps(figures) + "\n")


if __name__ == "__main__":
    main(sys.argv[1])
