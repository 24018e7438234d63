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
    CHECK(std::fabs(last.latency - 0.003) < 1e-6 && last.confidence > 0.5);
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
    CHECK(contacts->sent.size() == so_far);
    for (const auto& each : node.timers) CHECK(each.expired());
    node.timers.clear();
    CHECK(node.on_activate(state) == Return::SUCCESS);
    feel(node, 3'000, 300, readings.touched);
    CHECK(contacts->sent.back().accepted);
    CHECK(node.on_shutdown(state) == Return::SUCCESS);
    CHECK(!node.made<rclcpp::Subscription<Wrench>>("raw") && tf2_ros::TransformListener::alive == 0);
    for (const auto& each : node.timers) CHECK(each.expired());
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
    return result();
}
