// Rows that know nothing of each other, on several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

// Calls `work(from, to)` until all rows are done; as many rows at a time as the kernel's bindings take.
template <class Work>
void each_stretch(std::int64_t rows, int threads, const Work& work) {
    constexpr std::int64_t stretch = 256;
    std::atomic<std::int64_t> next{0};
    const auto take = [&] {
        for (std::int64_t from; (from = next.fetch_add(stretch)) < rows;) work(from, std::min(from + stretch, rows));
    };
    std::vector<std::thread> others;
    while (int(others.size()) + 1 < threads) others.emplace_back(take);
    take();
    for (std::thread& each : others) each.join();
}
