// node_test BUNDLE READINGS: the ROS layer on stubs of ROS, which say nothing of a real middleware.
#include "node.hpp"

#include <string>

#include "readings.hpp"

namespace {

using contactbench_ros::Node;
using Return = Node::CallbackReturn;
using Contact = contactbench_msgs::msg::Contact;
using Wrench = geometry_msgs::msg::WrenchStamped;
using Pose = geometry_msgs::msg::PoseStamped;
using Markers = visualization_msgs::msg::MarkerArray;
using Diagnostics = diagnostic_msgs::msg::DiagnosticArray;
using std_srvs::srv::Trigger;
template <class Message>
using Sent = rclcpp_lifecycle::LifecyclePublisher<Message>;
const rclcpp_lifecycle::State state;

rclcpp::NodeOptions options_of(const std::string& bundle, const std::string& source) {
    rclcpp::NodeOptions options;
    options.overrides = {{"bundle", bundle},           {"sensor_frame", std::string("ft")},
                         {"world_frame", std::string("base")}, {"flange_frame", std::string("tool0")},
                         {"pose_source", source},      {"wrench_topic", std::string("raw")}};
    return options;
}

rclcpp::Time at(int ms) { return rclcpp::Time(1'700'000'000 + ms / 1000, std::uint32_t(ms % 1000) * 1'000'000); }

void feel(Node& node, int from, int count, const double reading[6], const char* frame = "ft") {
    for (int ms = from; ms < from + count; ++ms) {
        node.get_clock()->present = at(ms + 3);
        Wrench message;
        message.header.stamp = at(ms), message.header.frame_id = frame;
        double w[6];
        noisy(reading, w);
        message.wrench = {{w[0], w[1], w[2]}, {w[3], w[4], w[5]}};
        if (ms % 10 == 0) {
            if (const auto poses = node.made<rclcpp::Subscription<Pose>>("pose")) {
                Pose pose;
                pose.header.stamp = at(ms), pose.header.frame_id = "base";
                poses->callback(pose);
            } else {
                geometry_msgs::msg::TransformStamped found;
                found.header.stamp = at(ms);
                tf2_ros::Buffer::known = {{{"base", "tool0"}, found}};
                if (const auto timer = node.timers.empty() ? nullptr : node.timers.front().lock()) timer->callback();
            }
        }
        node.made<rclcpp::Subscription<Wrench>>("raw")->callback(message);
    }
}

void what_is_wrong_leaves_it_unconfigured(const std::string& bundle) {
    Node missing(options_of("/nowhere", "tf")), other(options_of(bundle, "joints")), nameless(options_of(bundle, "tf"));
    CHECK(missing.on_configure(state) == Return::FAILURE);
    CHECK(!missing.made<Sent<Contact>>("~/contact"));
    CHECK(other.on_configure(state) == Return::FAILURE);
    auto options = options_of(bundle, "tf");
    options.overrides["flange_frame"] = std::string();
    Node frameless(options);
    CHECK(frameless.on_configure(state) == Return::FAILURE);
}

void a_touch_is_published(const std::string& bundle, const std::string& source, const Readings& readings) {
    Node node(options_of(bundle, source));
    CHECK(node.on_configure(state) == Return::SUCCESS);
    const auto contacts = node.made<Sent<Contact>>("~/contact");
    const auto wrenches = node.made<Sent<Wrench>>("~/wrench");
    const auto markers = node.made<Sent<Markers>>("~/markers");
    const auto diagnostics = node.made<Sent<Diagnostics>>("/diagnostics");
    feel(node, 0, 20, readings.touched);
    CHECK(contacts->sent.empty());  // not active
    CHECK(node.on_activate(state) == Return::SUCCESS);
    feel(node, 20, 500, readings.touched);
    CHECK(contacts->sent.size() == 500);
    const Contact& last = contacts->sent.back();
    CHECK(last.accepted && last.health.empty() && !last.reason.empty());
    CHECK(last.header.frame_id == "ft" && rclcpp::Time(last.header.stamp) == at(519));
    CHECK(std::fabs(last.latency - 0.073) < 2e-3 && last.confidence > 0.5);
    CHECK(std::isfinite(last.point.x + last.normal.z) && last.covariance[0] > 0 && last.covariance[4] > 0);
    CHECK(testing::close(last.covariance[1], last.covariance[3], 1e-9));
    const double pressed = -(last.wrench.force.x * last.normal.x + last.wrench.force.y * last.normal.y +
                             last.wrench.force.z * last.normal.z);
    CHECK(pressed > 4.0);  // of the tissue on the probe: against the outward normal
    const auto& arm = last.point;
    const auto& f = last.wrench.force;
    CHECK(std::fabs(last.wrench.torque.x - (arm.y * f.z - arm.z * f.y)) < 0.02);
    CHECK(std::fabs(last.wrench.torque.y - (arm.z * f.x - arm.x * f.z)) < 0.02);
    CHECK(last.region == 1);
    CHECK(wrenches->sent.back().wrench.force.x == last.wrench.force.x);
    CHECK(markers->sent.size() > 10 && markers->sent.size() < 30);  // 30 Hz in half a second
    const auto& shown = markers->sent.back().markers;
    CHECK(shown.size() == 2 && shown[0].action == 0 && shown[0].header.frame_id == "ft");
    CHECK(std::fabs(shown[1].points[1].x - shown[0].pose.position.x) < 1e-12);

    double broken[6] = {NAN, NAN, NAN, NAN, NAN, NAN};
    feel(node, 520, 50, broken);
    CHECK(!contacts->sent.back().accepted && contacts->sent.back().reason == "not_finite");
    CHECK(wrenches->sent.size() == 500);
    CHECK(markers->sent.back().markers[0].action == 2);  // taken away

    node.get_clock()->present = at(2'000);
    for (const auto& each : node.timers)
        if (const auto timer = each.lock()) timer->callback();
    CHECK(contacts->sent.back().health == std::vector<std::string>{"silent"});
    CHECK(diagnostics->sent.size() == 1 && diagnostics->sent[0].status[0].level == 2);
    CHECK(!diagnostics->sent[0].status[0].values.empty());

    const auto reply = std::make_shared<Trigger::Response>();
    node.made<rclcpp::Service<Trigger>>("~/zero")->callback(std::make_shared<Trigger::Request>(), reply);
    CHECK(!reply->success && reply->message.find("Nothing was changed") != std::string::npos);

    const std::size_t so_far = contacts->sent.size();
    CHECK(node.on_deactivate(state) == Return::SUCCESS);
    feel(node, 2'000, 20, readings.touched);
    CHECK(contacts->sent.size() == so_far + 1);  // it said that it ends
    CHECK(!contacts->sent.back().accepted && contacts->sent.back().reason == "stale");
    CHECK(contacts->sent.back().health == std::vector<std::string>{"inactive"});
    CHECK(std::isnan(contacts->sent.back().point.x) && std::isnan(contacts->sent.back().wrench.force.x));
    CHECK(rclcpp::Time(contacts->sent.back().header.stamp) == at(2'000));
    for (const auto& marker : markers->sent.back().markers) CHECK(marker.action == 2);
    for (const auto& each : node.timers) CHECK(each.expired());
    node.timers.clear();
    CHECK(node.on_activate(state) == Return::SUCCESS);
    feel(node, 3'000, 300, readings.touched);
    CHECK(contacts->sent.back().accepted && markers->sent.back().markers[0].action == 0);
    CHECK(node.on_shutdown(state) == Return::SUCCESS);
    CHECK(!node.made<rclcpp::Subscription<Wrench>>("raw") && tf2_ros::TransformListener::alive == 0);
    CHECK(contacts->sent.back().health == std::vector<std::string>{"inactive"});  // it was active
    CHECK(markers->sent.back().markers[1].action == 2);
    for (const auto& each : node.timers) CHECK(each.expired());
}

// Of the node's timers, in the order of their making: the poses', the watch, the diagnostics.
void ring(Node& node, std::size_t timer) { node.timers.at(timer).lock()->callback(); }

std::string value_of(const diagnostic_msgs::msg::DiagnosticStatus& status, const std::string& key) {
    for (const auto& each : status.values)
        if (each.key == key) return each.value;
    return "";
}

void only_accepted_contacts_are_shown(const std::string& bundle, const Readings& readings) {
    auto options = options_of(bundle, "topic");
    options.overrides["max_marker_rate"] = std::int64_t(0);
    Node node(options);
    CHECK(node.on_configure(state) == Return::SUCCESS && node.on_activate(state) == Return::SUCCESS);
    const auto contacts = node.made<Sent<Contact>>("~/contact");
    const auto markers = node.made<Sent<Markers>>("~/markers");
    feel(node, 0, 300, readings.touched);
    for (int turn = 0; turn < 36; ++turn) {  // forces that more than one place explains are among them
        double pushed[6];
        std::copy(readings.free, readings.free + 6, pushed);
        pushed[turn % 3] += 6.0 * std::cos(0.3 * turn), pushed[(turn + 1) % 3] += 6.0 * std::sin(0.3 * turn);
        feel(node, 300 + turn * 50, 50, pushed);
    }
    CHECK(contacts->sent.size() == markers->sent.size());
    std::size_t refused = 0;
    for (std::size_t i = 0; i < contacts->sent.size(); ++i) {
        const Contact& contact = contacts->sent[i];
        refused += !contact.accepted && std::isfinite(contact.point.x);
        for (const auto& marker : markers->sent[i].markers) {
            CHECK((marker.action == 0) == contact.accepted);
            CHECK(marker.lifetime.sec == 1);
        }
    }
    CHECK(refused > 0);
}

void slow_markers_do_not_blink(const std::string& bundle, const Readings& readings) {
    auto options = options_of(bundle, "topic");
    options.overrides["max_marker_rate"] = 0.5;
    Node node(options);
    CHECK(node.on_configure(state) == Return::SUCCESS && node.on_activate(state) == Return::SUCCESS);
    feel(node, 0, 10, readings.touched);
    CHECK(node.made<Sent<Markers>>("~/markers")->sent.at(0).markers[1].lifetime.sec == 4);
}

void a_bad_stamp_costs_that_message_only(const std::string& bundle, const std::string& source,
                                         const Readings& readings) {
    Node node(options_of(bundle, source));
    CHECK(node.on_configure(state) == Return::SUCCESS && node.on_activate(state) == Return::SUCCESS);
    const auto contacts = node.made<Sent<Contact>>("~/contact");
    const auto diagnostics = node.made<Sent<Diagnostics>>("/diagnostics");
    feel(node, 0, 300, readings.touched);
    Wrench wrench;
    wrench.header.stamp.sec = -5, wrench.header.frame_id = "ft";
    node.made<rclcpp::Subscription<Wrench>>("raw")->callback(wrench);
    CHECK(contacts->sent.size() == 300);
    if (source == "topic") {
        Pose pose;
        pose.header.stamp.sec = -5, pose.header.frame_id = "base";
        node.made<rclcpp::Subscription<Pose>>("pose")->callback(pose);
    } else {
        tf2_ros::Buffer::known.begin()->second.header.stamp.sec = -5;
        ring(node, 0);
    }
    ring(node, node.timers.size() - 1);
    const auto& told = diagnostics->sent.at(0).status[0];
    CHECK(told.level == 2 && told.message.find("negative") != std::string::npos);
    CHECK(value_of(told, "messages without a time") == "2" && value_of(told, "callbacks failed") == "0");
    feel(node, 300, 100, readings.touched);
    CHECK(contacts->sent.back().accepted);
}

void what_a_callback_throws_is_told(const std::string& bundle, const Readings& readings) {
    Node node(options_of(bundle, "tf"));
    CHECK(node.on_configure(state) == Return::SUCCESS && node.on_activate(state) == Return::SUCCESS);
    const auto diagnostics = node.made<Sent<Diagnostics>>("/diagnostics");
    feel(node, 0, 300, readings.touched);
    tf2_ros::Buffer::broken = true;
    ring(node, 0), ring(node, 0);
    tf2_ros::Buffer::broken = false;
    ring(node, 2), ring(node, 2);
    const auto& told = diagnostics->sent.at(0).status[0];
    CHECK(told.level == 2 && told.message == "The look-up of a pose failed: no such thing");
    CHECK(value_of(told, "callbacks failed") == "2");
    CHECK(diagnostics->sent.at(1).status[0].level == 0);
}

// Poses by tf that have no stamp: only where the parameter says so are they taken.
void a_transform_without_a_stamp(const std::string& bundle, bool fixed, const Readings& readings) {
    auto options = options_of(bundle, "tf");
    if (fixed) options.overrides["static_pose"] = true;
    Node node(options);
    CHECK(node.on_configure(state) == Return::SUCCESS && node.on_activate(state) == Return::SUCCESS);
    const auto contacts = node.made<Sent<Contact>>("~/contact");
    for (int ms = 0; ms < 400; ++ms) {
        node.get_clock()->present = at(ms);
        tf2_ros::Buffer::known = {{{"base", "tool0"}, geometry_msgs::msg::TransformStamped()}};
        if (ms % 10 == 0) ring(node, 0);
        Wrench message;
        message.header.stamp = at(ms), message.header.frame_id = "ft";
        double w[6];
        noisy(readings.touched, w);
        message.wrench = {{w[0], w[1], w[2]}, {w[3], w[4], w[5]}};
        node.made<rclcpp::Subscription<Wrench>>("raw")->callback(message);
    }
    CHECK(contacts->sent.back().accepted == fixed);
    CHECK(contacts->sent.back().health == (fixed ? std::vector<std::string>{} : std::vector<std::string>{"no_pose"}));
    ring(node, 2);
    const std::string& told = node.made<Sent<Diagnostics>>("/diagnostics")->sent.at(0).status[0].message;
    CHECK((told.find("set static_pose") == std::string::npos) == fixed);
}

void rates_may_be_integers(const std::string& bundle) {
    auto options = options_of(bundle, "tf");
    for (const char* name : {"pose_rate", "max_contact_rate", "diagnostics_rate"}) {
        options.overrides[name] = std::int64_t(50);
    }
    Node node(options);
    CHECK(node.on_configure(state) == Return::SUCCESS && node.on_activate(state) == Return::SUCCESS);
    CHECK(node.timers.at(0).lock()->period == std::chrono::milliseconds(20));
    for (const rclcpp::ParameterValue& wrong :
         {rclcpp::ParameterValue(std::int64_t(0)), rclcpp::ParameterValue(1e9), rclcpp::ParameterValue(std::string("a"))}) {
        options.overrides["pose_rate"] = wrong;
        bool refused = false;
        try {
            Node other(options);
        } catch (const std::runtime_error&) {
            refused = true;
        }
        CHECK(refused);
    }
}

void cleaned_up_it_can_be_configured_again(const std::string& bundle) {
    Node node(options_of(bundle, "topic"));
    for (int i = 0; i < 2; ++i) {
        CHECK(node.on_configure(state) == Return::SUCCESS);
        CHECK(node.on_activate(state) == Return::SUCCESS);
        CHECK(node.on_deactivate(state) == Return::SUCCESS);
        CHECK(node.on_cleanup(state) == Return::SUCCESS);
        CHECK(!node.made<rclcpp::Subscription<Pose>>("pose"));
    }
    CHECK(node.on_error(state) == Return::SUCCESS);
}

}  // namespace

int main(int, char** argv) {
    const Readings readings(argv[2]);
    what_is_wrong_leaves_it_unconfigured(argv[1]);
    a_touch_is_published(argv[1], "topic", readings);
    a_touch_is_published(argv[1], "tf", readings);
    cleaned_up_it_can_be_configured_again(argv[1]);
    only_accepted_contacts_are_shown(argv[1], readings);
    slow_markers_do_not_blink(argv[1], readings);
    a_bad_stamp_costs_that_message_only(argv[1], "topic", readings);
    a_bad_stamp_costs_that_message_only(argv[1], "tf", readings);
    what_a_callback_throws_is_told(argv[1], readings);
    a_transform_without_a_stamp(argv[1], true, readings);
    a_transform_without_a_stamp(argv[1], false, readings);
    rates_may_be_integers(argv[1]);
    return result();
}
