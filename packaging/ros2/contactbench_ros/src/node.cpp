#include "node.hpp"

#include <rcl_interfaces/msg/parameter_descriptor.hpp>
#include <tf2/exceptions.h>
#include <tf2/time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

namespace contactbench_ros {

namespace {

using namespace std::chrono_literals;

constexpr int longest_burst = 200;       // readings that wait while the executor is busy: late, not lost
constexpr double arrow_length = 0.05;    // m
constexpr double sphere_diameter = 0.006;
constexpr double longest_lifetime = 3'600.0;  // s, of a marker
constexpr int throttle_ms = 5'000;

constexpr double lowest_rate = 0.1, highest_rate = 1e4;  // Hz

std::chrono::nanoseconds period_of(double rate) {
    // No range of a parameter keeps NaN out.
    return std::chrono::nanoseconds(std::int64_t(1e9 / (rate > lowest_rate ? std::min(rate, highest_rate) : lowest_rate)));
}

// rclcpp::Time throws where it is negative; the core refuses that.
double seconds_of(const builtin_interfaces::msg::Time& stamp) { return stamp.sec + 1e-9 * stamp.nanosec; }

template <class Vector>
void put(Vector& to, const double from[3]) {
    to.x = from[0], to.y = from[1], to.z = from[2];
}

}  // namespace

Node::Node(const rclcpp::NodeOptions& options) : LifecycleNode("contactbench", options) {
    const auto declare_rate = [this](const char* name, double usual, double lowest) {
        rcl_interfaces::msg::ParameterDescriptor about;
        about.dynamic_typing = true;  // a YAML file says 100 or 100.0
        about.integer_range.resize(1);
        about.integer_range[0].from_value = std::int64_t(std::ceil(lowest));
        about.integer_range[0].to_value = std::int64_t(highest_rate);
        about.floating_point_range.resize(1);
        about.floating_point_range[0].from_value = lowest, about.floating_point_range[0].to_value = highest_rate;
        declare_parameter(name, rclcpp::ParameterValue(usual), about);
        rate(name);  // throws where it is no number
    };
    declare_parameter<std::string>("bundle", "");
    declare_parameter<bool>("accept_unverified", false);
    declare_parameter<bool>("self_test", true);
    declare_parameter<std::string>("sensor_frame", "");
    declare_parameter<std::string>("world_frame", "");
    declare_parameter<std::string>("flange_frame", "");
    declare_parameter<std::string>("wrench_topic", "wrench");
    declare_parameter<std::string>("pose_source", "tf");
    declare_parameter<std::string>("pose_topic", "pose");
    declare_parameter<bool>("static_pose", false);
    declare_rate("pose_rate", 100.0, lowest_rate);
    declare_rate("max_contact_rate", 0.0, 0.0);
    declare_rate("max_wrench_rate", 0.0, 0.0);
    declare_rate("max_marker_rate", 30.0, 0.0);
    declare_rate("diagnostics_rate", 1.0, lowest_rate);
}

template <class Work>
void Node::guarded(const char* what, Work&& work) {
    try {
        work();
    } catch (const std::exception& error) {
        ++failures_;
        failure_ = std::string("The ") + what + " failed: " + error.what();
        RCLCPP_ERROR_THROTTLE(get_logger(), *get_clock(), throttle_ms, "%s", failure_.c_str());
    }
}

double Node::rate(const char* name) const {
    const rclcpp::Parameter given = get_parameter(name);
    if (given.get_type() == rclcpp::ParameterType::PARAMETER_INTEGER) return double(given.as_int());
    return given.as_double();
}

Node::CallbackReturn Node::on_configure(const rclcpp_lifecycle::State&) {
    Settings settings;
    settings.bundle = get_parameter("bundle").as_string();
    settings.sensor_frame = get_parameter("sensor_frame").as_string();
    settings.world_frame = world_frame_ = get_parameter("world_frame").as_string();
    settings.accept_unverified = get_parameter("accept_unverified").as_bool();
    settings.self_test = get_parameter("self_test").as_bool();
    settings.contact_rate = rate("max_contact_rate");
    settings.wrench_rate = rate("max_wrench_rate");
    settings.marker_rate = rate("max_marker_rate");
    flange_frame_ = get_parameter("flange_frame").as_string();
    static_pose_ = get_parameter("static_pose").as_bool();
    const std::string source = get_parameter("pose_source").as_string();
    std::string error;
    if (source != "tf" && source != "topic") {
        error = "parameter pose_source: it is '" + source + "', but has to be 'tf' or 'topic'";
    } else if (source == "tf" && flange_frame_.empty()) {
        error = "parameter flange_frame: give the frame of the flange, or of the sensor where the bundle holds no mount";
    } else if (core_.open(settings, error)) {
        prepare_messages();
        const auto lasting = rclcpp::QoS(10);
        contact_publisher_ = create_publisher<Contact>("~/contact", lasting);
        wrench_publisher_ = create_publisher<Wrench>("~/wrench", lasting);
        marker_publisher_ = create_publisher<Markers>("~/markers", lasting);
        diagnostics_publisher_ = create_publisher<Diagnostics>("/diagnostics", lasting);
        wrenches_ = create_subscription<Wrench>(get_parameter("wrench_topic").as_string(),
                                                rclcpp::SensorDataQoS().keep_last(longest_burst),
                                                [this](const Wrench& message) { guarded("wrench", [&] { take_wrench(message); }); });
        listen_to_poses();
        zero_ = create_service<Trigger>(
            "~/zero", [this](const Trigger::Request::SharedPtr, Trigger::Response::SharedPtr response) {
                guarded("zero service", [&] {
                    ZeroWords words = core_.zero();
                    response->success = words.trusted;
                    response->message = std::move(words.message);
                });
            });
        RCLCPP_INFO(get_logger(), "Bundle loaded: %s. Poses have to be those of the %s.", settings.bundle.c_str(),
                    core_.has_mount() ? "flange" : "sensor, because the bundle holds no mount");
        return CallbackReturn::SUCCESS;
    }
    RCLCPP_ERROR(get_logger(), "%s", error.c_str());
    return CallbackReturn::FAILURE;
}

void Node::listen_to_poses() {
    if (get_parameter("pose_source").as_string() == "topic") {
        poses_ = create_subscription<Pose>(get_parameter("pose_topic").as_string(),
                                           rclcpp::SensorDataQoS().keep_last(longest_burst),
                                           [this](const Pose& message) { guarded("pose", [&] { take_pose(message); }); });
        return;
    }
    transforms_ = std::make_unique<tf2_ros::Buffer>(get_clock());
    listener_ = std::make_unique<tf2_ros::TransformListener>(*transforms_);
}

Node::CallbackReturn Node::on_activate(const rclcpp_lifecycle::State& state) {
    LifecycleNode::on_activate(state);
    last_transform_ = 0.0;
    failure_.clear(), failures_ = 0;
    core_.start();
    if (transforms_)
        pose_timer_ = create_wall_timer(period_of(rate("pose_rate")),
                                        [this] { guarded("look-up of a pose", [this] { look_up_pose(); }); });
    watch_timer_ = create_wall_timer(100ms, [this] { guarded("watch for silence", [this] { watch(); }); });
    diagnostics_timer_ = create_wall_timer(period_of(rate("diagnostics_rate")),
                                           [this] { guarded("diagnostics", [this] { diagnose(); }); });
    return CallbackReturn::SUCCESS;
}

Node::CallbackReturn Node::on_deactivate(const rclcpp_lifecycle::State& state) {
    say_farewell();
    pose_timer_.reset(), watch_timer_.reset(), diagnostics_timer_.reset();
    LifecycleNode::on_deactivate(state);
    return CallbackReturn::SUCCESS;
}

void Node::say_farewell() {
    if (!core_.is_active()) return;
    core_.stop();
    answer_ = core_.farewell();
    guarded("last contact", [this] {
        const rclcpp::Time present = now();
        publish_contact(present);
        publish_markers(present);
    });
}

void Node::release() {
    say_farewell();  // a shutdown of an active node
    core_.close();
    pose_timer_.reset(), watch_timer_.reset(), diagnostics_timer_.reset();
    wrenches_.reset(), poses_.reset(), zero_.reset();
    listener_.reset(), transforms_.reset();
    contact_publisher_.reset(), wrench_publisher_.reset(), marker_publisher_.reset(), diagnostics_publisher_.reset();
}

Node::CallbackReturn Node::on_cleanup(const rclcpp_lifecycle::State&) { return release(), CallbackReturn::SUCCESS; }

Node::CallbackReturn Node::on_shutdown(const rclcpp_lifecycle::State&) { return release(), CallbackReturn::SUCCESS; }

Node::CallbackReturn Node::on_error(const rclcpp_lifecycle::State&) { return release(), CallbackReturn::SUCCESS; }

void Node::prepare_messages() {
    using visualization_msgs::msg::Marker;
    const std::string frame = get_parameter("sensor_frame").as_string();
    // Should the node die, they go by themselves; a slow rate must not make them blink.
    const double marker_rate = rate("max_marker_rate");
    const double lifetime = marker_rate > 0.0 ? std::clamp(2.0 / marker_rate, 1.0, longest_lifetime) : 1.0;
    contact_ = Contact();
    contact_.header.frame_id = compensated_.header.frame_id = frame;
    contact_.reason.reserve(32);
    contact_.health.reserve(answer_.health.size());
    markers_.markers.assign(2, Marker());
    for (std::size_t i = 0; i < 2; ++i) {
        Marker& marker = markers_.markers[i];
        marker.header.frame_id = frame;
        marker.ns = "contact";
        marker.id = std::int32_t(i);
        marker.pose.orientation.w = 1.0;
        marker.lifetime.sec = std::int32_t(std::ceil(lifetime));
        marker.color.r = 1.0F, marker.color.g = 0.5F, marker.color.a = 1.0F;
    }
    Marker& sphere = markers_.markers[0];
    sphere.type = Marker::SPHERE;
    sphere.scale.x = sphere.scale.y = sphere.scale.z = sphere_diameter;
    Marker& arrow = markers_.markers[1];  // the way that the tissue presses
    arrow.type = Marker::ARROW;
    arrow.scale.x = 0.3 * sphere_diameter, arrow.scale.y = sphere_diameter;
    arrow.points.resize(2);
}

void Node::take_wrench(const Wrench& message) {
    const auto& force = message.wrench.force;
    const auto& torque = message.wrench.torque;
    const double reading[6] = {force.x, force.y, force.z, torque.x, torque.y, torque.z};
    const Stamp& stamp = message.header.stamp;
    const Taken taken =
        core_.wrench(message.header.frame_id, seconds_of(stamp), now().seconds(), reading, answer_);
    if (taken != Taken::used) return;  // diagnostics say why
    if (answer_.publish_contact) publish_contact(stamp);
    if (answer_.publish_wrench) {
        compensated_.header.stamp = stamp;
        put(compensated_.wrench.force, answer_.contact.force);
        put(compensated_.wrench.torque, answer_.contact.torque);
        wrench_publisher_->publish(compensated_);
    }
    if (answer_.publish_markers) publish_markers(stamp);
}

void Node::take_pose(const Pose& message) {
    const auto& p = message.pose.position;
    const auto& q = message.pose.orientation;
    const double position[3] = {p.x, p.y, p.z}, xyzw[4] = {q.x, q.y, q.z, q.w};
    core_.pose(message.header.frame_id, seconds_of(message.header.stamp), position, xyzw);
}

void Node::look_up_pose() {
    try {
        const auto found = transforms_->lookupTransform(world_frame_, flange_frame_, tf2::TimePointZero);
        const auto& p = found.transform.translation;
        const auto& q = found.transform.rotation;
        const double position[3] = {p.x, p.y, p.z}, xyzw[4] = {q.x, q.y, q.z, q.w};
        double time = seconds_of(found.header.stamp);
        // A frame that nothing moves has no time of its own; neither has one that a careless node moves.
        if (time == 0.0 && static_pose_) time = now().seconds();
        else if (time != 0.0 && time == last_transform_) return;
        last_transform_ = time;
        core_.pose(world_frame_, time, position, xyzw);
    } catch (const tf2::TransformException& error) {
        RCLCPP_WARN_THROTTLE(get_logger(), *get_clock(), throttle_ms, "No pose from %s to %s: %s",
                             world_frame_.c_str(), flange_frame_.c_str(), error.what());
    }
}

void Node::watch() {
    const rclcpp::Time present = now();
    if (!core_.silence(present.seconds(), answer_)) return;
    publish_contact(present);
    publish_markers(present);
}

void Node::diagnose() {
    const rclcpp::Time present = now();
    Status status = core_.status(present.seconds());
    Diagnostics message;
    message.header.stamp = present;
    message.status.resize(1);
    auto& only = message.status.front();
    only.level = static_cast<unsigned char>(status.level);
    only.name = std::string(get_name()) + ": contact";
    only.hardware_id = get_parameter("sensor_frame").as_string();
    only.message = std::move(status.message);
    if (failures_ > 0) {
        only.level = static_cast<unsigned char>(Level::error);
        only.message = failure_;
    }
    status.values.emplace_back("callbacks failed", std::to_string(failures_));
    failures_ = 0;
    only.values.resize(status.values.size());
    for (std::size_t i = 0; i < status.values.size(); ++i) {
        only.values[i].key = std::move(status.values[i].first);
        only.values[i].value = std::move(status.values[i].second);
    }
    diagnostics_publisher_->publish(message);
}

void Node::publish_contact(const Stamp& stamp) {
    const cb_contact& contact = answer_.contact;
    contact_.header.stamp = stamp;
    contact_.accepted = contact.accepted != 0;
    contact_.reason = answer_.reason();
    contact_.health.resize(answer_.health_count);
    std::copy_n(answer_.health.begin(), answer_.health_count, contact_.health.begin());
    put(contact_.point, contact.point);
    put(contact_.normal, contact.normal);
    put(contact_.wrench.force, contact.force);
    put(contact_.wrench.torque, contact.torque);
    std::copy_n(contact.covariance, contact_.covariance.size(), contact_.covariance.begin());
    contact_.confidence = contact.confidence;
    contact_.region = std::uint32_t(std::max(contact.region, 0));
    contact_.latency = contact.latency;
    contact_publisher_->publish(contact_);
}

void Node::publish_markers(const Stamp& stamp) {
    using visualization_msgs::msg::Marker;
    const cb_contact& contact = answer_.contact;
    const bool shown = contact.accepted != 0 && answer_.has_point();
    for (Marker& marker : markers_.markers) {
        marker.header.stamp = stamp;
        marker.action = shown ? Marker::ADD : Marker::DELETE;
    }
    if (shown) {
        put(markers_.markers[0].pose.position, contact.point);
        auto& ends = markers_.markers[1].points;
        put(ends[1], contact.point);
        const double begin[3] = {contact.point[0] + arrow_length * contact.normal[0],
                                 contact.point[1] + arrow_length * contact.normal[1],
                                 contact.point[2] + arrow_length * contact.normal[2]};
        put(ends[0], begin);
    }
    marker_publisher_->publish(markers_);
}

}  // namespace contactbench_ros
