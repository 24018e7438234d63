"""``contactbench ros``: a runtime config as a lifecycle node of ROS 2."""

from pathlib import Path

from contactbench.pipeline.console import Noun

ros_app = Noun()


@ros_app.command(
    example=(
        "ros runtime.zip -- --ros-args -r wrench:=/ft_sensor/wrench -r pose:=/tool_pose",
        "ros runtime.zip --managed -- --ros-args --params-file contactbench.yaml",
    ),
    as_json=False,
)
def ros(
    bundle: Path,
    arguments: list[str] | None = None,
    /,
    unverified: bool = False,
    managed: bool = False,
    allow_remote: bool = False,
) -> None:
    """Run a bundle as a lifecycle node of ROS 2 (extra ros).

    It does what `contactbench run` does: it takes raw wrenches and poses of the flange from topics, and publishes
    the compensated wrench, accepted contacts, the reason where there is none, markers and diagnostics. It ends with
    Ctrl-C, or when it is shut down.

    Parameters
    ----------
    bundle
        Folder or zip file of a runtime config; a parameter bundle of ROS comes before it.
    arguments
        What ROS takes, after --: --ros-args with parameters and other names of topics.
    unverified
        Accept a bundle that is not verified.
    managed
        Wait to be configured and activated, as by ros2 lifecycle.
    allow_remote
        Other machines may take part, neither encrypted nor signed; ROS_AUTOMATIC_DISCOVERY_RANGE says which.
    """
    from contactbench.pipeline.runtime.ros_node import serve

    serve(str(bundle), arguments or [], unverified=unverified, managed=managed, remote=allow_remote)
