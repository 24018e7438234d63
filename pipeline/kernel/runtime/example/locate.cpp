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
        char text[CB_LINE_ROOM];
        cb_line(&contact, &zero, text, sizeof text);
        std::fputs(text, stdout);
    }
    return std::fflush(stdout) == 0 ? 0 : 1;
}
