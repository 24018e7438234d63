#include "yaml.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <string_view>

#include "json.hpp"
#include "physics.hpp"

namespace contactbench::runtime {

namespace {

constexpr std::size_t longest_name = 200, width = 98;
constexpr double rounding = 1e-9;  // of the weight: less is no tilt
constexpr double along_z = 0.996;  // the cosine of some 5 degrees: further from z of W, a weight along z is the wrong one
constexpr std::string_view not_given = "(not given)";

[[noreturn]] void refuse_text(const std::string& file, const std::string& what) {
    refuse_file(CB_ERROR_VALUE, file, what);
}

bool letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool digit(char c) { return c >= '0' && c <= '9'; }

// Parts with one / between.
bool is_frame(std::string_view text) {
    if (text.size() > longest_name) return false;
    for (bool first = true;; first = false) {
        const std::string_view part = text.substr(0, text.find('/'));
        const auto fits = [](char c) { return letter(c) || digit(c) || c == '.' || c == '-'; };
        if (part.empty() || !std::all_of(part.begin(), part.end(), fits)) return false;
        if (first && !letter(part[0]) && !digit(part[0])) return false;
        if (part.size() == text.size()) return true;
        text.remove_prefix(part.size() + 1);
    }
}

bool is_tool(std::string_view text) {
    constexpr std::string_view start = "contactbench ";
    if (text.size() > longest_name || text.substr(0, start.size()) != start) return false;
    text.remove_prefix(start.size());
    const auto fits = [](char c) { return (letter(c) && c != '_') || digit(c) || c == '.' || c == '+' || c == '-'; };
    return !text.empty() && digit(text[0]) && std::all_of(text.begin(), text.end(), fits);
}

// The values of the lines `# name: value` below the title.
std::vector<std::string> facts_of(const std::string& file, std::string_view text,
                                  std::initializer_list<std::string_view> names) {
    std::vector<std::string> found;
    for (const std::string_view name : names) {
        text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
        const std::string start = "# " + std::string(name) + ": ";
        if (text.substr(0, start.size()) != start) refuse_text(file, "the head lacks '" + start + "...' where it belongs");
        found.emplace_back(text.substr(start.size(), text.find('\n') - start.size()));
    }
    return found;
}

std::string number(const std::string& file, double x) {
    if (!std::isfinite(x)) refuse_text(file, "a number that is not finite");
    const std::string digits = repr(x + 0.0);  // no -0.0
    const std::size_t e = std::min(digits.find('e'), digits.size());
    const bool whole = digits.find('.') == std::string::npos;
    return digits.substr(0, e) + (whole ? ".0" : "") + digits.substr(e);
}

std::string shown(const char* format, double x) {
    char text[64];
    std::snprintf(text, sizeof text, format, x);
    return text;
}

std::string quoted(const std::string& text) { return '"' + text + '"'; }

class Document {
public:
    Document(std::string file, const GravityLoad& load, const std::vector<double>& covariance, Vec3 down)
        : file_(std::move(file)), load_(load), C_(covariance), down_(down) {}

    std::string ros2(std::string_view told) {
        const auto facts = facts_of(
            file_, told, {"tool", "sensor_frame", "world_frame", "sensor_name", "broadcaster", "admittance"});
        const std::string &frame = facts[1], &world = facts[2], &sensor = facts[3];
        // A bundle names the nodes as contactbench does by itself.
        const std::string broadcaster = "force_torque_sensor_broadcaster", admittance = "admittance_controller";
        const bool given = sensor != not_given;
        if (!is_tool(facts[0]) || !is_frame(frame) || !is_frame(world) || (given && !is_frame(sensor)) ||
            facts[4] != broadcaster || facts[5] != admittance)
            refuse_text(file_, "a name in the head is not one that contactbench writes");
        line("# Gravity calibration for ros2_control.");
        line("# tool: " + facts[0]);
        line("# sensor_frame: " + frame);
        line("# world_frame: " + world);
        line("# sensor_name: " + sensor);
        line("# broadcaster: " + broadcaster);
        line("# admittance: " + admittance);
        units(frame);
        line("# This is a FRAGMENT, not a complete file: merge it into the robot's controller parameters, as");
        line("# docs/ros.md of contactbench describes.");
        line("# Checked against the sources of ros2_controllers 4.42.1, 5.17.0, 6.9.0. Needs 4.16.0 or newer:");
        line("# older broadcasters ignore the offset.");
        line("# CAUTION: the broadcasters of ros2_controllers 4.42.0, 4.42.1, 5.17.0 and 6.9.0 publish the reading");
        line("# with offset and multiplier, but what they export to other controllers stays as it was when they were");
        line("# configured. Do not chain admittance_controller to them: it would take a constant for the reading,");
        line("# and move the robot. Earlier ones export what they publish.");
        const bool tilted = std::fabs(down_.z) < along_z, hangs = down_.z > 0.0;
        const double sign = hangs ? 1.0 : -1.0, weight = std::max(sign * load_.gravity_W.z, 0.0);
        if (!tilted) warn("WARNING: ", weight, {0.0, 0.0, sign});
        line(broadcaster + ":");
        line("  ros__parameters:");
        if (given) {
            line("    sensor_name: " + quoted(sensor));
        } else {
            line("    # FILL IN the sensor's name in the ros2_control tag of the robot description, here and in");
            line("    # ft_sensor.name below: the broadcaster does not start without it.");
            line("    # sensor_name: \"SENSOR_NAME\"");
        }
        line("    frame_id: " + quoted(frame));
        line("    # ADDED to the reading: minus the bias. N and N*m.");
        line("    offset:");
        axes("force", -load_.force_bias, sigmas(3, 3));
        axes("torque", -load_.torque_bias, sigmas(9, 3));
        line("    # Applied after the offset; the calibration holds for 1.0 only.");
        line("    multiplier:");
        axes("force", {1, 1, 1}, {});
        axes("torque", {1, 1, 1}, {});
        if (tilted) {
            line("# NO " + admittance + ": it takes the weight along z of the base of its kinematics chain,");
            line("# and this robot is on a wall or a tilted base: down in the calibration's world frame is");
            line("#   " + list({down_.x, down_.y, down_.z}));
            line("# No fixed_world_frame makes that right. Compensate with contactbench's own runtime.");
            return out_;
        }
        line(admittance + ":");
        line("  ros__parameters:");
        line("    ft_sensor:");
        line("      # This controller removes no bias. It has to read what the broadcaster exports (start that");
        line("      # one first), not the sensor itself. Mind the CAUTION above.");
        const std::string source = broadcaster + "/" + (given ? sensor : "SENSOR_NAME");
        line(std::string("      ") + (given ? "" : "# ") + "name: " + quoted(source));
        line("      frame:");
        line("        id: " + quoted(frame));
        line(std::string("    # z ") + (hangs ? "down" : "up") +
             ". Make it the base of the kinematics chain (kinematics.base): a frame tilted against that");
        line(hangs ? "    # base is used the wrong way round. A level frame with z up would need the weight above 0."
                   : "    # base, as on a wall, is used the wrong way round.");
        line("    fixed_world_frame:");
        line("      frame:");
        line("        id: " + quoted(world));
        line("    gravity_compensation:");
        line("      frame:");
        line("        id: " + quoted(frame));
        line("      CoG:");
        line("        # From the sensor origin, in the frame above, m.");
        sigma_comment("        ", sigmas(6, 3));
        line("        pos: " + list({load_.centre_of_mass_S.x, load_.centre_of_mass_S.y, load_.centre_of_mass_S.z}));
        line("        # Weight, N (not kg), taken along -z of fixed_world_frame.");
        if (hangs)
            line("        # Negative on purpose: this robot hangs from the ceiling, and its weight points along +z.");
        sigma_comment("        ", sigmas(2, 1));
        line("        force: " + number(file_, -sign * weight));
        return out_;
    }

    std::string ft_calib(std::string_view told) {
        const auto facts = facts_of(file_, told, {"tool", "com_frame", "child_frame"});
        if (!is_tool(facts[0]) || !is_frame(facts[1]) || !is_frame(facts[2]) || facts[1] == facts[2])
            refuse_text(file_, "a name in the head is not one that contactbench writes");
        if (!(dot(load_.gravity_W, down_) > 0.0)) refuse_text(file_, "the load has no weight that points down");
        const Vec3 g = load_.gravity_W, p = load_.centre_of_mass_S, F = load_.force_bias, M = load_.torque_bias;
        const double size = norm(g), mass = size / standard_gravity;
        const Vec3 down{standard_gravity * g.x / size, standard_gravity * g.y / size, standard_gravity * g.z / size};
        line("# Gravity calibration for KTH gravity_compensation (force_torque_tools).");
        line("# tool: " + facts[0]);
        line("# com_frame: " + facts[1]);
        line("# child_frame: " + facts[2]);
        units(facts[1]);
        line("# The node takes gravity from linear_acceleration in its imu topic, m/s^2, turned by tf. To give it");
        std::string where = "z up";
        if (down_.z > -along_z) (where = "down in it is ") += list({down_.x, down_.y, down_.z});
        line("# the gravity of this calibration, publish in the world frame of the calibration (" + where + "):");
        line("#   " + list({down.x, down.y, down.z}) + "  release 1.2 and older: taken as it is, pointing down");
        line("#   " + list({-down.x, -down.y, -down.z}) + "  versions that negate the reading first");
        line("# The wrong one of the two doubles the weight instead of removing it.");
        warn("WARNING, should the topic carry the vertical of that frame instead: ", mass * standard_gravity,
             down_);
        line("# SUBTRACTED from the reading: the bias itself. Force, N, then torque, N*m.");
        auto both = sigmas(3, 3);
        for (const double sigma : sigmas(9, 3)) both.push_back(sigma);
        sigma_comment("", both);
        line("bias: " + list({F.x, F.y, F.z, M.x, M.y, M.z}));
        line("# kg: the weight over 9.80665 m/s^2.");
        sigma_comment("", {weight_sigma(g, C_) / standard_gravity});
        line("gripper_mass: " + number(file_, mass));
        line("gripper_com_frame_id: " + quoted(facts[1]));
        line("gripper_com_child_frame_id: " + quoted(facts[2]));
        line("# x y z from the sensor origin, m, then roll pitch yaw, rad: without meaning for a point.");
        sigma_comment("", sigmas(6, 3));
        line("gripper_com_pose: " + list({p.x, p.y, p.z, 0.0, 0.0, 0.0}));
        return out_;
    }

private:
    void line(const std::string& text) { (out_ += text) += '\n'; }

    void units(const std::string& frame) {
        line("# Forces in N, torques in N*m about the origin of \"" + frame + "\", lengths in m, all in that frame.");
        line("# What remains after compensation is what the tissue does to the probe.");
    }

    std::vector<double> sigmas(std::size_t from, std::size_t count) const {
        std::vector<double> out;
        for (std::size_t i = from; i < from + count; ++i) out.push_back(std::sqrt(std::max(C_[13 * i], 0.0)));
        return out;
    }

    void sigma_comment(const std::string& indent, const std::vector<double>& values) {
        std::string text;
        for (const double value : values) (text += text.empty() ? "" : ", ") += shown("%.2g", value);
        if (std::any_of(values.begin(), values.end(), [](double x) { return x != 0.0; }))
            line(indent + "# 1 sigma: " + text);
    }

    void axes(const std::string& name, Vec3 v, const std::vector<double>& sigma) {
        line("      " + name + ":");
        sigma_comment("        ", sigma);
        line("        x: " + number(file_, v.x));
        line("        y: " + number(file_, v.y));
        line("        z: " + number(file_, v.z));
    }

    std::string list(std::initializer_list<double> values) const {
        std::string text;
        for (const double value : values) (text += text.empty() ? "[" : ", ") += number(file_, value);
        return text + "]";
    }

    // What is left where gravity is taken along `down`, if it is more than the calibration itself leaves.
    void warn(const std::string& before, double weight, Vec3 down) {
        const Vec3 g = load_.gravity_W;
        const double force = norm(g - weight * down);
        const double arm = norm(load_.centre_of_mass_S), torque = arm * force, least = rounding * norm(g);
        double share[6][6] = {};
        mean_share(load_, C_, share);
        const double force_sigma = std::sqrt(std::max(share[0][0] + share[1][1] + share[2][2], 0.0));
        const double torque_sigma = std::sqrt(std::max(share[3][3] + share[4][4] + share[5][5], 0.0));
        if (!(force > std::max(force_sigma, least) || torque > std::max(torque_sigma, arm * least))) return;
        const double tilt = std::atan2(norm(cross(g, down)), dot(g, down)) * (180.0 / M_PI);
        comment(before + "Gravity in the calibration is tilted by " + shown("%.3g", tilt) +
                " deg from the vertical of its world frame. Taken as vertical, it leaves up to " + shown("%.2g", force) +
                " N and " + shown("%.2g", torque) + " N*m in a compensated wrench, where the calibration itself leaves " +
                shown("%.2g", force_sigma) + " N and " + shown("%.2g", torque_sigma) +
                " N*m (1 sigma). Level the base, or put its tilt into the robot description, and calibrate again.");
    }

    void comment(std::string_view text) {
        while (text.size() > width) {
            const std::size_t at = text.rfind(' ', width);
            line("# " + std::string(text.substr(0, at)));
            text.remove_prefix(at + 1);
        }
        line("# " + std::string(text));
    }

    std::string file_, out_;
    const GravityLoad& load_;
    const std::vector<double>& C_;
    Vec3 down_;
};

void expect(const std::string& file, std::string_view told, std::string_view wanted) {
    if (told == wanted) return;
    const auto at = std::ptrdiff_t(first_difference(told, wanted));
    const auto number = 1 + std::count(wanted.begin(), wanted.begin() + at, '\n');
    refuse_text(file, "line " + std::to_string(number) + " is not what contactbench.json says");
}

}  // namespace

void check_gravity_files(const Files& files, const GravityLoad& gravity, const std::vector<double>& covariance,
                         Vec3 down_W) {
    const std::string& ros2 = files.at(ros2_name);
    expect(ros2_name, ros2, Document(ros2_name, gravity, covariance, down_W).ros2(ros2));
    const auto ft_calib = files.find(ft_calib_name);
    if (ft_calib != files.end())
        expect(ft_calib_name, ft_calib->second,
               Document(ft_calib_name, gravity, covariance, down_W).ft_calib(ft_calib->second));
}

}  // namespace contactbench::runtime
