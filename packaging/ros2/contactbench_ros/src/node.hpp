// The ROS side of the node: messages in, messages out. What is decided, `NodeCore` decides.
#pragma once

#include <builtin_interfaces/msg/time.hpp>
#include <contactbench_msgs/msg/contact.hpp>
#include <diagnostic_msgs/msg/diagnostic_array.hpp>
#include <geometry_msgs/msg/pose_stamped.hpp>
#include <geometry_msgs/msg/wrench_stamped.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_lifecycle/lifecycle_node.hpp>
#include <rclcpp_lifecycle/lifecycle_publisher.hpp>
#include <std_srvs/srv/trigger.hpp>
#include <visualization_msgs/msg/marker_array.hpp>

// The names without ++ are deprecated, and the others are missing in older distributions.
#if __has_include(<tf2_ros/buffer.hpp>)
#include <tf2_ros/buffer.hpp>
#include <tf2_ros/transform_listener.hpp>
#else
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#endif

#include <cstdint>
#include <memory>
#include <string>

#include "contactbench_ros/node_core.hpp"

namespace contactbench_ros {

class Node : public rclcpp_lifecycle::LifecycleNode {
public:
    explicit Node(const rclcpp::NodeOptions& options = rclcpp::NodeOptions());

    using CallbackReturn = rclcpp_lifecycle::node_interfaces::LifecycleNodeInterface::CallbackReturn;
    CallbackReturn on_configure(const rclcpp_lifecycle::State& state) override;
    CallbackReturn on_activate(const rclcpp_lifecycle::State& state) override;
    CallbackReturn on_deactivate(const rclcpp_lifecycle::State& state) override;
    CallbackReturn on_cleanup(const rclcpp_lifecycle::State& state) override;
    CallbackReturn on_shutdown(const rclcpp_lifecycle::State& state) override;
    CallbackReturn on_error(const rclcpp_lifecycle::State& state) override;

private:
    template <class Message>
    using Publisher = typename rclcpp_lifecycle::LifecyclePublisher<Message>::SharedPtr;
    using Contact = contactbench_msgs::msg::Contact;
    using Diagnostics = diagnostic_msgs::msg::DiagnosticArray;
    using Markers = visualization_msgs::msg::MarkerArray;
    using Pose = geometry_msgs::msg::PoseStamped;
    using Trigger = std_srvs::srv::Trigger;
    using Stamp = builtin_interfaces::msg::Time;
    using Wrench = geometry_msgs::msg::WrenchStamped;

    void listen_to_poses();
    double rate(const char* name) const;
    void say_farewell();
    void release();
    void prepare_messages();
    void take_wrench(const Wrench& message);
    void take_pose(const Pose& message);
    void look_up_pose();
    void watch();
    void diagnose();
    void publish_contact(const Stamp& stamp);
    void publish_markers(const Stamp& stamp);
    // A callback: what it throws costs that message, and diagnostics say it.
    template <class Work>
    void guarded(const char* what, Work&& work);

    NodeCore core_;
    Answer answer_;
    std::string world_frame_, flange_frame_;
    bool static_pose_ = false;
    double last_transform_ = 0.0;
    std::string failure_;  // of a callback, since the last diagnostics
    std::uint64_t failures_ = 0;

    rclcpp::Subscription<Wrench>::SharedPtr wrenches_;
    rclcpp::Subscription<Pose>::SharedPtr poses_;
    std::unique_ptr<tf2_ros::Buffer> transforms_;
    std::unique_ptr<tf2_ros::TransformListener> listener_;
    Publisher<Contact> contact_publisher_;
    Publisher<Wrench> wrench_publisher_;
    Publisher<Markers> marker_publisher_;
    Publisher<Diagnostics> diagnostics_publisher_;
    rclcpp::Service<Trigger>::SharedPtr zero_;
    rclcpp::TimerBase::SharedPtr pose_timer_, watch_timer_, diagnostics_timer_;
    // Filled again and again: the wrench's callback allocates no message.
    Contact contact_;
    Wrench compensated_;
    Markers markers_;
};

}  // namespace contactbench_ros
