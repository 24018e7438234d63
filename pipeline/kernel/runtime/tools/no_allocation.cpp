// contactbench-no_allocation BUNDLE SAMPLES: counts what the heap is asked for between cb_open and cb_close, and
// fails if it is anything.
#include <cstdio>

#include "contactbench_runtime.h"
#include "counted_heap.hpp"
#include "samples.hpp"

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    cb_error error{};
    error.size = sizeof error;
    counting = true;
    cb_runtime* runtime = cb_open(argv[1], &error);
    counting = false;
    const long opening = requests;
    const auto samples = read_samples(argv[2]);
    if (!runtime || samples.empty() || opening == 0) {
        std::fprintf(stderr, "%s\n", runtime ? "no samples, or nothing was counted" : error.message);
        return 2;
    }
    cb_contact contact{};
    contact.size = sizeof contact;
    long crowded = 0, implausible = 0, joined = 0;
    requests = 0;
    counting = true;
    for (const Sample& s : samples) {
        cb_update(runtime, s.wrench, s.R_WS, s.time, &contact);
        crowded += contact.candidates > 1;
        implausible += contact.reason == CB_IMPLAUSIBLE;
        joined += contact.reason == CB_TWO_TOUCHES;
    }
    cb_reset(runtime);
    counting = false;
    std::printf("%ld requests in cb_open, %ld in %zu updates; of these %ld with more than one candidate, %ld"
                " implausible, %ld with two touches\n",
                opening, requests, samples.size(), crowded, implausible, joined);
    cb_close(runtime);
    return requests == 0 ? 0 : 1;
}
