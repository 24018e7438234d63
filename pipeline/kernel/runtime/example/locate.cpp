// contactbench-locate BUNDLE < samples > contacts
//
// A sample a line: time Fx Fy Fz Mx My Mz and the nine numbers of R_WS, row by row; s, N, N*m. Spaces, commas
// and brackets between them are all the same, so a JSON array of the sixteen does as well. A contact a line, as
// a JSON object. A line that is no sample ends the program with status 1 and its number.
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>

#include "contactbench_runtime.h"

namespace {

constexpr int numbers = 16;

bool parse(std::string_view line, double out[numbers]) {
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

void print(const cb_contact& c) {
    std::fputs("{\"time\":", stdout);
    print_number(c.time);
    std::printf(",\"reason\":\"%s\",\"accepted\":%s", cb_reason_name(c.reason), c.accepted ? "true" : "false");
    print_array("point_S_m", c.point, 3);
    print_array("filtered_point_S_m", c.filtered_point, 3);
    print_array("normal_S", c.normal, 3);
    print_one("torque_Nm", c.torque_about_normal);
    print_array("force_S_N", c.force, 3);
    print_array("torque_S_Nm", c.torque, 3);
    print_array("covariance_S_m2", c.covariance, 9);
    std::printf(",\"face\":%d,\"vertex\":%d,\"region\":%d,\"candidates\":%d", int(c.face), int(c.vertex),
                int(c.region), int(c.candidates));
    print_one("confidence", c.confidence);
    print_one("misfit", c.misfit);
    print_one("left_over_Nm", c.left_over);
    print_one("arm_m", c.arm);
    print_array("runner_up_S_m", c.runner_up, 3);
    print_array("second_S_m", c.second, 3);
    std::fputs("}\n", stdout);
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
        double v[numbers];
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        if (!parse(line, v)) {
            std::fprintf(stderr, "line %ld: not sixteen numbers: time Fx Fy Fz Mx My Mz R_WS\n", n);
            return 1;
        }
        if (cb_update(runtime.get(), v + 1, v + 7, v[0], &contact) != CB_OK) {
            std::fprintf(stderr, "line %ld: the runtime did not take it\n", n);
            return 1;
        }
        print(contact);
    }
    return std::fflush(stdout) == 0 ? 0 : 1;
}
