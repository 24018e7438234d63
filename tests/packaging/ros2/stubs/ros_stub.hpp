// As much of ROS 2 as the node uses, with the same names and signatures, and no middleware behind it: what is published
// is kept, and a test hands messages to the callbacks itself. Contact is made from Contact.msg by the test.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace builtin_interfaces::msg {
struct Time {
    std::int32_t sec = 0;
    std::uint32_t nanosec = 0;
};
struct Duration {
    std::int32_t sec = 0;
    std::uint32_t nanosec = 0;
};
}  // namespace builtin_interfaces::msg

namespace std_msgs::msg {
struct Header {
    builtin_interfaces::msg::Time stamp;
    std::string frame_id;
};
struct ColorRGBA {
    float r = 0, g = 0, b = 0, a = 0;
};
}  // namespace std_msgs::msg

namespace geometry_msgs::msg {
struct Vector3 {
    double x = 0, y = 0, z = 0;
};
struct Point {
    double x = 0, y = 0, z = 0;
};
struct Quaternion {
    double x = 0, y = 0, z = 0, w = 1;
};
struct Wrench {
    Vector3 force, torque;
};
struct WrenchStamped {
    std_msgs::msg::Header header;
    Wrench wrench;
};
struct Pose {
    Point position;
    Quaternion orientation;
};
struct PoseStamped {
    std_msgs::msg::Header header;
    Pose pose;
};
struct Transform {
    Vector3 translation;
    Quaternion rotation;
};
struct TransformStamped {
    std_msgs::msg::Header header;
    std::string child_frame_id;
    Transform transform;
};
}  // namespace geometry_msgs::msg

namespace visualization_msgs::msg {
struct Marker {
    static constexpr std::int32_t ARROW = 0, SPHERE = 2, ADD = 0, DELETE = 2;
    std_msgs::msg::Header header;
    std::string ns;
    std::int32_t id = 0, type = 0, action = 0;
    geometry_msgs::msg::Pose pose;
    geometry_msgs::msg::Vector3 scale;
    std_msgs::msg::ColorRGBA color;
    builtin_interfaces::msg::Duration lifetime;
    std::vector<geometry_msgs::msg::Point> points;
};
struct MarkerArray {
    std::vector<Marker> markers;
};
}  // namespace visualization_msgs::msg

namespace diagnostic_msgs::msg {
struct KeyValue {
    std::string key, value;
};
struct DiagnosticStatus {
    unsigned char level = 0;
    std::string name, message, hardware_id;
    std::vector<KeyValue> values;
};
struct DiagnosticArray {
    std_msgs::msg::Header header;
    std::vector<DiagnosticStatus> status;
};
}  // namespace diagnostic_msgs::msg

namespace std_srvs::srv {
struct Trigger {
    struct Request {
        using SharedPtr = std::shared_ptr<Request>;
    };
    struct Response {
        using SharedPtr = std::shared_ptr<Response>;
        bool success = false;
        std::string message;
    };
};
}  // namespace std_srvs::srv

namespace rcl_interfaces::msg {
struct FloatingPointRange {
    double from_value = 0, to_value = 0, step = 0;
};
struct IntegerRange {
    std::int64_t from_value = 0, to_value = 0;
    std::uint64_t step = 0;
};
struct ParameterDescriptor {
    bool dynamic_typing = false;
    std::vector<FloatingPointRange> floating_point_range;
    std::vector<IntegerRange> integer_range;
};
}  // namespace rcl_interfaces::msg

enum rcl_clock_type_t { RCL_ROS_TIME = 1, RCL_SYSTEM_TIME };

namespace rclcpp {

class Time {
public:
    Time() = default;
    Time(std::int32_t sec, std::uint32_t nanosec, rcl_clock_type_t = RCL_SYSTEM_TIME)
        : ns_(std::int64_t(sec) * 1'000'000'000 + nanosec) {
        if (sec < 0) throw std::runtime_error("cannot store a negative time point in rclcpp::Time");
    }
    Time(const builtin_interfaces::msg::Time& t, rcl_clock_type_t type = RCL_ROS_TIME) : Time(t.sec, t.nanosec, type) {}
    operator builtin_interfaces::msg::Time() const {
        builtin_interfaces::msg::Time t;
        t.sec = std::int32_t(ns_ / 1'000'000'000), t.nanosec = std::uint32_t(ns_ % 1'000'000'000);
        return t;
    }
    std::int64_t nanoseconds() const { return ns_; }
    double seconds() const { return 1e-9 * double(ns_); }
    bool operator==(const Time& other) const { return ns_ == other.ns_; }

private:
    std::int64_t ns_ = 0;
};

class Clock {
public:
    using SharedPtr = std::shared_ptr<Clock>;
    rcl_clock_type_t get_clock_type() const { return RCL_ROS_TIME; }
    Time now() const { return present; }
    Time present;  // set by a test
};

struct Logger {};
inline Logger get_logger(const std::string&) { return {}; }
#define RCLCPP_INFO(logger, ...) (void(logger), std::printf(__VA_ARGS__), std::puts(""))
#define RCLCPP_ERROR(logger, ...) (void(logger), std::printf("error: " __VA_ARGS__), std::puts(""))
#define RCLCPP_FATAL(logger, ...) (void(logger), std::printf("fatal: " __VA_ARGS__), std::puts(""))
#define RCLCPP_ERROR_THROTTLE(logger, clock, ms, ...) \
    (void(logger), void(clock), void(ms), std::printf("error: " __VA_ARGS__), std::puts(""))
#define RCLCPP_WARN_THROTTLE(logger, clock, ms, ...) \
    (void(logger), void(clock), void(ms), std::printf("warning: " __VA_ARGS__), std::puts(""))

struct QoS {
    explicit QoS(std::size_t) {}
    QoS& keep_last(std::size_t) { return *this; }
};
struct SensorDataQoS : QoS {
    SensorDataQoS() : QoS(5) {}
};

using ParameterValue = std::variant<bool, std::int64_t, double, std::string>;
enum class ParameterType : std::uint8_t {
    PARAMETER_BOOL = 1,
    PARAMETER_INTEGER,
    PARAMETER_DOUBLE,
    PARAMETER_STRING
};

namespace exceptions {
struct InvalidParameterTypeException : std::runtime_error {
    using std::runtime_error::runtime_error;
};
struct InvalidParameterValueException : std::runtime_error {
    using std::runtime_error::runtime_error;
};
}  // namespace exceptions

class Parameter {
public:
    Parameter(std::string name, ParameterValue value) : name_(std::move(name)), value_(std::move(value)) {}
    ParameterType get_type() const { return ParameterType(value_.index() + 1); }
    bool as_bool() const { return as<bool>(); }
    std::int64_t as_int() const { return as<std::int64_t>(); }
    double as_double() const { return as<double>(); }
    const std::string& as_string() const { return as<std::string>(); }

private:
    template <class T>
    const T& as() const {
        const T* there = std::get_if<T>(&value_);
        if (!there) throw exceptions::InvalidParameterTypeException("parameter '" + name_ + "' has invalid type");
        return *there;
    }
    std::string name_;
    ParameterValue value_;
};

class NodeOptions {
public:
    std::map<std::string, ParameterValue> overrides;
};

template <class Message>
struct Subscription {
    using SharedPtr = std::shared_ptr<Subscription>;
    std::function<void(const Message&)> callback;
};

struct TimerBase {
    using SharedPtr = std::shared_ptr<TimerBase>;
    std::chrono::nanoseconds period;
    std::function<void()> callback;
};

template <class Type>
struct Service {
    using SharedPtr = std::shared_ptr<Service>;
    std::function<void(typename Type::Request::SharedPtr, typename Type::Response::SharedPtr)> callback;
};

namespace node_interfaces {
struct NodeBaseInterface {};
}  // namespace node_interfaces

namespace executors {
struct SingleThreadedExecutor {
    void add_node(const std::shared_ptr<node_interfaces::NodeBaseInterface>&) {}
    void spin() {}
};
}  // namespace executors

inline void init(int argc, char** argv) {
    for (int i = 1; i < argc; ++i)
        if (argv[i] == std::string("--ros-args")) throw std::runtime_error("failed to parse arguments");
}
inline bool shutdown() { return true; }

}  // namespace rclcpp

namespace rclcpp_lifecycle {

struct State {};

struct Managed {
    virtual ~Managed() = default;
    bool active = false;
};

template <class Message>
struct LifecyclePublisher : Managed {
    using SharedPtr = std::shared_ptr<LifecyclePublisher>;
    void publish(const Message& message) {
        if (!active) throw std::logic_error("published while not active");
        sent.push_back(message);
    }
    std::vector<Message> sent;
};

namespace node_interfaces {
struct LifecycleNodeInterface {
    enum class CallbackReturn : std::uint8_t { SUCCESS = 97, FAILURE = 98, ERROR = 99 };
    virtual ~LifecycleNodeInterface() = default;
    virtual CallbackReturn on_configure(const State&) { return CallbackReturn::SUCCESS; }
    virtual CallbackReturn on_activate(const State&) { return CallbackReturn::SUCCESS; }
    virtual CallbackReturn on_deactivate(const State&) { return CallbackReturn::SUCCESS; }
    virtual CallbackReturn on_cleanup(const State&) { return CallbackReturn::SUCCESS; }
    virtual CallbackReturn on_shutdown(const State&) { return CallbackReturn::SUCCESS; }
    virtual CallbackReturn on_error(const State&) { return CallbackReturn::FAILURE; }
};
}  // namespace node_interfaces

class LifecycleNode : public node_interfaces::LifecycleNodeInterface {
public:
    LifecycleNode(std::string name, const rclcpp::NodeOptions& options) : name_(std::move(name)), options_(options) {}

    void declare_parameter(const std::string& name, const rclcpp::ParameterValue& usual,
                           const rcl_interfaces::msg::ParameterDescriptor& about = {}) {
        const auto found = options_.overrides.find(name);
        const rclcpp::ParameterValue& given = found == options_.overrides.end() ? usual : found->second;
        if (!about.dynamic_typing && given.index() != usual.index())
            throw rclcpp::exceptions::InvalidParameterTypeException("parameter '" + name + "' has invalid type");
        const auto within = [](const auto* value, const auto& ranges) {
            return !value || ranges.empty() || !(*value < ranges[0].from_value || *value > ranges[0].to_value);
        };
        if (!within(std::get_if<double>(&given), about.floating_point_range) ||
            !within(std::get_if<std::int64_t>(&given), about.integer_range))
            throw rclcpp::exceptions::InvalidParameterValueException("parameter '" + name + "' is not in range");
        parameters_[name] = given;
    }
    template <class T>
    void declare_parameter(const std::string& name, const T& usual,
                           const rcl_interfaces::msg::ParameterDescriptor& about = {}) {
        declare_parameter(name, rclcpp::ParameterValue(usual), about);
        if (!std::holds_alternative<T>(parameters_.at(name)))
            throw rclcpp::exceptions::InvalidParameterTypeException("parameter '" + name + "' has invalid type");
    }
    rclcpp::Parameter get_parameter(const std::string& name) const {
        return rclcpp::Parameter(name, parameters_.at(name));
    }
    template <class Message>
    typename LifecyclePublisher<Message>::SharedPtr create_publisher(const std::string& topic, const rclcpp::QoS&) {
        auto made = std::make_shared<LifecyclePublisher<Message>>();
        made_[topic] = made;
        managed_.push_back(made);
        return made;
    }
    template <class Message, class Callback>
    typename rclcpp::Subscription<Message>::SharedPtr create_subscription(const std::string& topic, const rclcpp::QoS&,
                                                                          Callback&& callback) {
        auto made = std::make_shared<rclcpp::Subscription<Message>>();
        made->callback = callback;
        made_[topic] = made;
        return made;
    }
    template <class Type, class Callback>
    typename rclcpp::Service<Type>::SharedPtr create_service(const std::string& name, Callback&& callback) {
        auto made = std::make_shared<rclcpp::Service<Type>>();
        made->callback = callback;
        made_[name] = made;
        return made;
    }
    template <class Period, class Callback>
    rclcpp::TimerBase::SharedPtr create_wall_timer(Period period, Callback&& callback) {
        auto made = std::make_shared<rclcpp::TimerBase>();
        made->period = period, made->callback = callback;
        timers.push_back(made);
        return made;
    }
    rclcpp::Time now() const { return clock_->now(); }
    rclcpp::Clock::SharedPtr get_clock() const { return clock_; }
    rclcpp::Logger get_logger() const { return {}; }
    const char* get_name() const { return name_.c_str(); }
    std::shared_ptr<rclcpp::node_interfaces::NodeBaseInterface> get_node_base_interface() { return {}; }

    CallbackReturn on_activate(const State&) override { return manage(true); }
    CallbackReturn on_deactivate(const State&) override { return manage(false); }

    // For tests. Null: the node has let it go, or never made it.
    template <class Made>
    std::shared_ptr<Made> made(const std::string& name) const {
        const auto found = made_.find(name);
        return found == made_.end() ? nullptr : std::static_pointer_cast<Made>(found->second.lock());
    }
    std::vector<std::weak_ptr<rclcpp::TimerBase>> timers;

private:
    CallbackReturn manage(bool active) {
        for (const auto& each : managed_)
            if (const auto there = each.lock()) there->active = active;
        return CallbackReturn::SUCCESS;
    }
    std::string name_;
    rclcpp::NodeOptions options_;
    std::map<std::string, rclcpp::ParameterValue> parameters_;
    std::map<std::string, std::weak_ptr<void>> made_;
    std::vector<std::weak_ptr<Managed>> managed_;
    rclcpp::Clock::SharedPtr clock_ = std::make_shared<rclcpp::Clock>();
};

}  // namespace rclcpp_lifecycle

namespace tf2 {
struct TransformException : std::runtime_error {
    using std::runtime_error::runtime_error;
};
using TimePoint = std::chrono::time_point<std::chrono::system_clock, std::chrono::nanoseconds>;
inline const TimePoint TimePointZero{};
}  // namespace tf2

namespace tf2_ros {
struct Buffer {
    explicit Buffer(const rclcpp::Clock::SharedPtr&) {}
    geometry_msgs::msg::TransformStamped lookupTransform(const std::string& target, const std::string& source,
                                                         const tf2::TimePoint&) const {
        const auto found = known.find({target, source});
        if (broken) throw std::out_of_range("no such thing");
        if (found == known.end()) throw tf2::TransformException("no such frame");
        return found->second;
    }
    inline static std::map<std::pair<std::string, std::string>, geometry_msgs::msg::TransformStamped> known;
    inline static bool broken = false;  // it throws what nobody expects
};
struct TransformListener {
    explicit TransformListener(Buffer&) { ++alive; }
    ~TransformListener() { --alive; }
    inline static int alive = 0;
};
}  // namespace tf2_ros

#include "contact_stub.hpp"  // made from Contact.msg
