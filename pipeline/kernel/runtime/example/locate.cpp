// contactbench-locate BUNDLE < samples > contacts
//
// A sample a line: time Fx Fy Fz Mx My Mz and the nine numbers of R_WS, row by row; s, N, N*m. Spaces, commas
// and brackets between them are all the same, so a JSON array of the sixteen does as well. A contact a line, as
// a JSON object. A line that is no sample ends the program with status 1 and its number.
//
// Or poses and samples as they come, and the library finds the orientation at each sample:
//   pose time R R R R R R R R R x y z                  of the flange or the sensor, m; nan where it is not known
//   sample time arrival flags Fx Fy Fz Mx My Mz
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>

#include "contactbench_runtime.h"

namespace {

constexpr int most_numbers = 16;

bool parse(std::string_view line, int numbers, double out[most_numbers]) {
    constexpr std::string_view between = " \t\r,[]";
    int count = 0;
    for (;;) {
        const std::size_t from = line.find_first_not_of(between);
        if (from == std::string_view::npos) return count == numbers;
        line.remove_prefix(from);
        if (count == numbers) return false;
        const auto read = std::from_chars(line.data(), line.data() + line.size(), out[count]);
        const std::size_t length = std::size_t(read.ptr - line.data());
        if (read.ec != std::errc() || (length < line.size() && between.find(line[length]) == std::string_view::npos))
            return false;
        ++count;
        line.remove_prefix(length);
    }
}

// JSON knows no NaN: null stands for what there is none of. The digits read back as the same double.
void print_number(double x) {
    char text[32];
    if (!std::isfinite(x)) {
        std::fputs("null", stdout);
        return;
    }
    *std::to_chars(text, text + sizeof text - 1, x).ptr = '\0';
    std::fputs(text, stdout);
}

void print_array(const char* name, const double* values, int count) {
    if (!std::isfinite(values[0])) {
        std::printf(",\"%s\":null", name);
        return;
    }
    for (int i = 0; i < count; ++i) {
        if (i == 0)
            std::printf(",\"%s\":[", name);
        else
            std::fputc(',', stdout);
        print_number(values[i]);
    }
    std::fputc(']', stdout);
}

void print_one(const char* name, double value) {
    std::printf(",\"%s\":", name);
    print_number(value);
}

void print_health(unsigned word) {
    constexpr const char* names[] = {"frozen", "silent", "flagged", "no_pose", "clock"};
    std::fputs(",\"health\":[", stdout);
    bool first = true;
    for (int bit = 0; bit < 5; ++bit)
        if (word >> bit & 1) std::printf("%s\"%s\"", first ? "" : ",", names[bit]), first = false;
    std::fputc(']', stdout);
}

// Takes the line as what it says it is; returns why it is none, or null. `told`: there is a contact to print.
const char* take(cb_runtime* runtime, std::string_view line, cb_contact& contact, bool& told) {
    double v[most_numbers];
    told = false;
    const auto says = [&](std::string_view word) {
        if (line.substr(0, word.size()) != word) return false;
        line.remove_prefix(word.size());
        return true;
    };
    if (says("pose ")) {
        if (!parse(line, 13, v)) return "no pose: time, R (9), x y z";
        cb_pose(runtime, v + 1, v + 10, v[0]);  // one that is not used is as good as none
        return nullptr;
    }
    told = true;
    if (says("sample ")) {
        if (!parse(line, 9, v)) return "no sample: time arrival flags Fx Fy Fz Mx My Mz";
        cb_sample sample = CB_SAMPLE_INIT;
        sample.time = v[0], sample.arrival = v[1], sample.flags = v[2] >= 0 && v[2] < 256 ? std::uint32_t(v[2]) : 0;
        std::copy(v + 3, v + 9, sample.wrench);
        return cb_update_sample(runtime, &sample, &contact) == CB_OK ? nullptr : "the runtime did not take it";
    }
    if (!parse(line, 16, v)) return "not sixteen numbers: time Fx Fy Fz Mx My Mz R_WS";
    return cb_update(runtime, v + 1, v + 7, v[0], &contact) == CB_OK ? nullptr : "the runtime did not take it";
}

void print(const cb_contact& c, const cb_zero& zero) {
    std::fputs("{\"time\":", stdout);
    print_number(c.time);
    std::printf(",\"reason\":\"%s\",\"accepted\":%s", cb_reason_name(c.reason), c.accepted ? "true" : "false");
    print_health(c.health);
    print_one("latency_s", c.latency);
    print_one("pose_age_s", c.pose_age);
    print_array("point_S_m", c.point, 3);
    print_array("filtered_point_S_m", c.filtered_point, 3);
    print_array("normal_S", c.normal, 3);
    print_one("torque_Nm", c.torque_about_normal);
    print_array("force_S_N", c.force, 3);
    print_array("torque_S_Nm", c.torque, 3);
    print_array("covariance_S_m2", c.covariance, 9);
    print_one("within_m", c.within);
    constexpr const char* marks[] = {"null", "\"measured\"", "\"invented\"", "\"untouchable\""};
    std::printf(",\"face\":%d,\"vertex\":%d,\"region\":%d,\"on\":%s,\"candidates\":%d", int(c.face), int(c.vertex),
                int(c.region), marks[c.on - CB_ON_NOTHING], int(c.candidates));
    print_one("confidence", c.confidence);
    print_one("misfit", c.misfit);
    print_one("left_over_Nm", c.left_over);
    print_one("arm_m", c.arm);
    print_one("torsion_arm_m", c.torsion_arm);
    print_one("torsion_since_s", c.torsion_since);
    print_array("runner_up_S_m", c.runner_up, 3);
    print_array("second_S_m", c.second, 3);
    constexpr const char* states[] = {"unknown", "confirmed", "doubtful", "off"};
    std::printf(",\"zero\":{\"state\":\"%s\"", states[zero.state]);
    print_one("age_s", zero.age);
    print_array("force_S_N", zero.force, 3);
    print_array("torque_S_Nm", zero.torque, 3);
    print_one("shift_m", zero.shift);
    print_one("shift_sigma_m", zero.shift_sigma);
    if (zero.follows != CB_FOLLOWS_OFF) {
        constexpr const char* follows[] = {"off", "waiting", "following", "stopped"};
        std::printf(",\"follows\":\"%s\"", follows[zero.follows]);
        print_one("seen_s", zero.seen);
        print_array("taken_S", c.taken, 6);
        print_array("taken_sigma_S", zero.taken_sigma, 6);
        print_array("raw_S", c.raw, 6);
    }
    std::fputs("}}\n", stdout);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: contactbench-locate BUNDLE < samples > contacts\n", stderr);
        return 2;
    }
    cb_error error = CB_ERROR_INIT;
    const std::unique_ptr<cb_runtime, void (*)(cb_runtime*)> runtime(cb_open(argv[1], &error), cb_close);
    if (!runtime) {
        std::fprintf(stderr, "%s\n", error.message);
        return 1;
    }
    std::string line;
    cb_contact contact = CB_CONTACT_INIT;
    for (long n = 1; std::getline(std::cin, line); ++n) {
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        bool told = false;
        if (const char* wrong = take(runtime.get(), line, contact, told)) {
            std::fprintf(stderr, "line %ld: %s\n", n, wrong);
            return 1;
        }
        if (!told) continue;
        cb_zero zero = CB_ZERO_INIT;
        cb_check_zero(runtime.get(), &zero);
        print(contact, zero);
    }
    return std::fflush(stdout) == 0 ? 0 : 1;
}
