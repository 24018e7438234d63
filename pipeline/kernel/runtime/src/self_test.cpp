#include "self_test.hpp"

#include <charconv>
#include <cmath>
#include <memory>
#include <string_view>
#include <vector>

#include "bundle.hpp"
#include "folder.hpp"
#include "json.hpp"
#include "sha256.hpp"

namespace contactbench::runtime {

namespace {

constexpr std::string_view pose_head = "pose,time_s,R11,R12,R13,R21,R22,R23,R31,R32,R33,x_m,y_m,z_m";
constexpr std::string_view sample_head =
    "sample,time_s,arrival_s,flags,Fx_N,Fy_N,Fz_N,Mx_Nm,My_Nm,Mz_Nm,reason,accepted,health,pose_age_s,"
    "force_x_N,force_y_N,force_z_N,torque_x_Nm,torque_y_Nm,torque_z_Nm,point_x_m,point_y_m,point_z_m,"
    "normal_x,normal_y,normal_z,filtered_x_m,filtered_y_m,filtered_z_m,second_x_m,second_y_m,second_z_m,"
    "sigma_x_m,sigma_y_m,sigma_z_m,confidence,misfit,left_over_Nm";
constexpr std::size_t inputs = 10, names = 3;
constexpr std::size_t largest = 4 << 20;
constexpr double tolerance = 1e-9;  // other processors and libraries round otherwise

using Cells = std::vector<std::string_view>;

Cells cells_of(std::string_view text, char between) {
    Cells cells;
    for (std::size_t at; (at = text.find(between)) != text.npos; text.remove_prefix(at + 1))
        cells.push_back(text.substr(0, at));
    cells.push_back(text);
    return cells;
}

class Replay {
public:
    explicit Replay(const Bundle& bundle) : runtime_(bundle.model, bundle.config.settings), file_(bundle.config.self_test) {}

    void run(std::string_view text, std::size_t samples) {
        if (text.size() > largest) refuse_file(CB_ERROR_SELF_TEST, file_, "larger than 4 MiB");
        Cells lines = cells_of(text, '\n');
        if (!lines.back().empty()) refuse_file(CB_ERROR_SELF_TEST, file_, "its last line has no end");
        lines.pop_back();
        if (lines.size() < 2 || lines[0] != pose_head || lines[1] != sample_head)
            refuse_file(CB_ERROR_SELF_TEST, file_, "the first two lines are not those of test vectors");
        const Cells columns = cells_of(sample_head, ',');
        std::size_t found = 0;
        for (line_ = 3; line_ <= lines.size(); ++line_) {
            const Cells cells = cells_of(lines[line_ - 1], ',');
            if (cells[0] == "pose" && cells.size() == cells_of(pose_head, ',').size()) {
                pose(cells);
            } else if (cells[0] == "sample" && cells.size() == columns.size()) {
                sample(cells, columns);
                ++found;
            } else {
                refuse_line("is neither a pose nor a sample");
            }
        }
        if (found != samples) refuse_file(CB_ERROR_SELF_TEST, file_, "not as many samples as self_test.samples says");
    }

private:
    void pose(const Cells& cells) {
        double v[13];
        for (std::size_t i = 0; i < 13; ++i) v[i] = number(cells[i + 1]);
        runtime_.pose(v + 1, v + 10, v[0]);  // one that is not used is as good as none
    }

    void sample(const Cells& cells, const Cells& columns) {
        RuntimeSample given{};
        given.time = number(cells[1]), given.arrival = number(cells[2]), given.flags = bits(cells[3]);
        for (std::size_t i = 0; i < 6; ++i) given.wrench[i] = number(cells[4 + i]);
        const RuntimeContact c = runtime_.update(given);
        const std::string said[names] = {reason_name(c.reason), c.accepted ? "1" : "0", std::to_string(c.health)};
        for (std::size_t i = 0; i < names; ++i)
            if (cells[inputs + i] != said[i]) differ(columns[inputs + i], cells[inputs + i], said[i]);
        std::vector<double> here{c.pose_age};
        const auto add = [&](const double* values, std::size_t count) { here.insert(here.end(), values, values + count); };
        add(c.wrench, 6), add(c.point, 3), add(c.normal, 3), add(c.filtered_point, 3), add(c.second, 3);
        // -0 and rounding below 0 are 0; NaN stays.
        for (const int i : {0, 4, 8}) here.push_back(std::sqrt(c.covariance[i] < 0.0 ? 0.0 : c.covariance[i]));
        add(&c.confidence, 1), add(&c.misfit, 1), add(&c.left_over, 1);
        for (std::size_t i = 0; i < here.size(); ++i) {
            const std::string_view cell = cells[inputs + names + i];
            if (!near(number(cell), here[i]))
                differ(columns[inputs + names + i], cell, std::isfinite(here[i]) ? repr(here[i]) : "nothing");
        }
    }

    static bool near(double told, double here) {
        if (std::isnan(told) || !std::isfinite(here)) return std::isnan(told) && !std::isfinite(here);
        return std::fabs(told - here) <= tolerance * std::max(1.0, std::fabs(told));
    }

    // Nothing stands for NaN. In the one spelling: readers differ in what else they take for a number.
    double number(std::string_view cell) const {
        double value = std::nan("");
        if (cell.empty()) return value;
        const auto read = std::from_chars(cell.data(), cell.data() + cell.size(), value);
        if (read.ec != std::errc() || !std::isfinite(value) || repr(value) != cell)
            refuse_line("holds something other than a number");
        return value;
    }

    std::uint32_t bits(std::string_view cell) const {
        std::uint8_t value = 0;
        const auto read = std::from_chars(cell.data(), cell.data() + cell.size(), value);
        if (read.ec != std::errc() || std::to_string(value) != cell) refuse_line("holds flags that are none");
        return value;
    }

    [[noreturn]] void refuse_line(const char* what) const {
        refuse_file(CB_ERROR_SELF_TEST, file_ + ": line " + std::to_string(line_), what);
    }

    [[noreturn]] void differ(std::string_view column, std::string_view told, const std::string& here) const {
        throw LoadError(CB_ERROR_SELF_TEST,
                        file_ + ": line " + std::to_string(line_) + ": " + std::string(column) + " is " +
                            (told.empty() ? "empty" : std::string(told.substr(0, 40))) + ", but this runtime says " +
                            here +
                            ": the bundle was edited, or is for another runtime; export it again");
    }

    Runtime runtime_;
    std::string file_;
    std::size_t line_ = 0;
};

}  // namespace

void replay_self_test(const std::string& folder) {
    const Files files = read_folder(folder);
    const Bundle bundle = load_bundle(folder);
    const Config& config = bundle.config;
    if (config.self_test.empty())
        refuse_file(CB_ERROR_SELF_TEST, config_name, "self_test is null, there are no test vectors");
    const auto file = files.find(config.self_test);
    // Loading has read the folder once more: an export may have come between.
    for (const auto& [name, hash] : config.files)
        if (name == config.self_test && (file == files.end() || sha256(file->second) != hash))
            refuse_file(CB_ERROR_HASH, name, "not the file that was exported");
    if (file == files.end()) refuse_file(CB_ERROR_FILE, config.self_test, "missing");
    std::make_unique<Replay>(bundle)->run(file->second, config.self_test_samples);
}

}  // namespace contactbench::runtime
