#include "node.hpp"

int main(int argc, char** argv) {
    rclcpp::init(argc, argv);
    // One thread: the core takes one message at a time.
    rclcpp::executors::SingleThreadedExecutor executor;
    const auto node = std::make_shared<contactbench_ros::Node>();
    executor.add_node(node->get_node_base_interface());
    executor.spin();
    rclcpp::shutdown();
    return 0;
}
