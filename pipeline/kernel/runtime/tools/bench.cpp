// contactbench-bench BUNDLE SAMPLES: nanoseconds of each cb_update (clock included), as one JSON object.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "contactbench_runtime.h"
#include "samples.hpp"

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fputs("usage: contactbench-bench BUNDLE SAMPLES\n", stderr);
        return 2;
    }
    cb_error error{};
    error.size = sizeof error;
    cb_runtime* runtime = cb_open(argv[1], &error);
    const std::vector<Sample> samples = read_samples(argv[2]);
    if (!runtime || samples.empty()) {
        std::fprintf(stderr, "%s\n", runtime ? "no samples" : error.message);
        return 1;
    }
    std::vector<double> ns;
    ns.reserve(samples.size());
    long found = 0;
    cb_contact contact{};
    contact.size = sizeof contact;
    for (const Sample& s : samples) {
        const auto start = std::chrono::steady_clock::now();
        cb_update(runtime, s.wrench, s.R_WS, s.time, &contact);
        const auto stop = std::chrono::steady_clock::now();
        ns.push_back(std::chrono::duration<double, std::nano>(stop - start).count());
        found += contact.accepted;
    }
    std::sort(ns.begin(), ns.end());
    const auto at = [&](double share) { return ns[std::size_t(share * double(ns.size() - 1))]; };
    std::printf("{\"samples\":%zu,\"accepted\":%ld,\"p50_ns\":%.0f,\"p99_ns\":%.0f,\"p999_ns\":%.0f,\"max_ns\":%.0f}\n",
                ns.size(), found, at(0.5), at(0.99), at(0.999), ns.back());
    cb_close(runtime);
}
