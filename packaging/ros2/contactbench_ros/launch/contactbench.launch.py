"""Starts the node with a parameter file, configures and activates it."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, EmitEvent, RegisterEventHandler
from launch.events import matches_action
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import LifecycleNode
from launch_ros.event_handlers import OnStateTransition
from launch_ros.events.lifecycle import ChangeState
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare
from lifecycle_msgs.msg import Transition


def generate_launch_description() -> LaunchDescription:
    """Return the node and what takes it to active."""
    share = FindPackageShare("contactbench_ros")
    # A string, also where the folder is called 2026.
    bundle = ParameterValue(LaunchConfiguration("bundle"), value_type=str)
    node = LifecycleNode(
        package="contactbench_ros",
        executable="contactbench_node",
        name="contactbench",
        namespace=LaunchConfiguration("namespace"),
        output="screen",
        parameters=[LaunchConfiguration("params_file"), {"bundle": bundle}],
    )

    def change(transition: int) -> EmitEvent:
        event = ChangeState(lifecycle_node_matcher=matches_action(node), transition_id=transition)
        return EmitEvent(event=event)

    return LaunchDescription(
        [
            DeclareLaunchArgument("bundle", description="Folder that `contactbench bundle export` wrote."),
            DeclareLaunchArgument("namespace", default_value=""),
            DeclareLaunchArgument(
                "params_file",
                default_value=PathJoinSubstitution([share, "config", "contactbench.yaml"]),
                description="Frames, topics and rates.",
            ),
            # Only once it is inactive: a bundle that is refused leaves it unconfigured.
            RegisterEventHandler(
                OnStateTransition(
                    target_lifecycle_node=node,
                    start_state="configuring",
                    goal_state="inactive",
                    entities=[change(Transition.TRANSITION_ACTIVATE)],
                )
            ),
            node,
            change(Transition.TRANSITION_CONFIGURE),
        ]
    )
