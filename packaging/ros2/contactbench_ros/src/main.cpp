#include "node.hpp"

#include <exception>

int main(int argc, char** argv) {
    try {
        rclcpp::init(argc, argv);
        // One thread: the core takes one message at a time.
        rclcpp::executors::SingleThreadedExecutor executor;
        const auto node = std::make_shared<contactbench_ros::Node>();
        executor.add_node(node->get_node_base_interface());
        executor.spin();
        rclcpp::shutdown();
    } catch (const std::exception& error) {  // an argument of ROS, or a parameter of another type
        RCLCPP_FATAL(rclcpp::get_logger("contactbench"), "%s", error.what());
        rclcpp::shutdown();
        return 1;
    }
    return 0;
}
