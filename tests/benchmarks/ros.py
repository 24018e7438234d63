"""The ROS node at 1 kHz, on real ROS 2: which wrenches another process gets back compensated, and how late."""

import time
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from benchmarks.bundle_example import example_config
from waiting import until

from contactbench.pipeline.errors import InputError
from contactbench.pipeline.study.report import Figure, StudyReport

_RATE_HZ, _LATE_MS = 1_000, 20.0


def run(seconds: float = 60.0) -> StudyReport:
    """Measure it: reliable both ways, from a message's stamp to its receipt by the process that sent it."""
    try:
        from geometry_msgs.msg import WrenchStamped
        from runtime.ros_peer import STILL, Peer, start
    except ModuleNotFoundError as error:
        raise InputError(f"this needs {error.name}: use `packaging/run ros benchmark`.") from error
    config, late = example_config(1_000), list[float]()
    count = round(seconds * _RATE_HZ)
    readings = np.random.default_rng(1).normal(config.gravity.predict(np.eye(3)), 0.02, (count, 6))

    def take(told: Any) -> None:
        late.append(time.time() - told.header.stamp.sec - 1e-9 * told.header.stamp.nanosec)

    with TemporaryDirectory(prefix="contactbench-") as name, Peer() as peer:
        config.write(Path(name) / "bundle")
        peer.listen("/contactbench/wrench", WrenchStamped, take=take)
        pose = peer.held()
        with start(Path(name) / "bundle", *STILL):
            peer.meet()
            begin = time.monotonic()
            for sent, reading in enumerate(readings, 1):
                peer.pushed(peer.node.get_clock().now().to_msg(), reading)
                while (wait := begin + sent / _RATE_HZ - time.monotonic()) > 0:
                    peer.spin(wait)
            took = time.monotonic() - begin
            with suppress(AssertionError):
                until(lambda: peer.spin() or len(late) == count, 10)
        peer.node.destroy_publisher(pose)
    median, p99 = (float(1e3 * np.quantile(late, share)) for share in (0.5, 0.99))
    figures = (
        Figure("1 kHz", "wrenches sent per second", count / took, "Hz", least=0.99 * _RATE_HZ),
        Figure("1 kHz", "received of sent", len(late) / count, least=1.0),
        Figure("1 kHz", "latency, median", median, "ms"),
        Figure("1 kHz", "latency, 99th percentile", p99, "ms", most=_LATE_MS),
    )
    return StudyReport("ROS", {"seconds": seconds}, figures, ())
