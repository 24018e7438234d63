// Work split over the processor's cores.
#pragma once

#include <algorithm>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace contactbench::bindings {

// How many parts `in_parts` makes: each of `least` items or more.
inline std::size_t parts_of(std::size_t count, std::size_t least) {
    return std::min<std::size_t>({std::max(1u, std::thread::hardware_concurrency()), 8, 1 + count / least});
}

// Calls work(from, to, part) for parts that are all of 0 to `count`, in order; each on a thread of its own, as far as there are
// any. Items must not know of each other, so that the answer does not depend on the parts. Throws what the first of the
// parts threw that did.
template <class Work>
void in_parts(std::size_t count, std::size_t least, const Work& work) {
    const std::size_t parts = parts_of(count, least);
    std::vector<std::exception_ptr> thrown(parts);
    const auto take = [&](std::size_t p) noexcept {
        try {
            work(count * p / parts, count * (p + 1) / parts, p);
        } catch (...) {
            thrown[p] = std::current_exception();
        }
    };
    std::vector<std::thread> threads;
    threads.reserve(parts);
    try {
        while (threads.size() + 1 < parts) threads.emplace_back(take, threads.size() + 1);
    } catch (const std::system_error&) {
        // No more threads are to be had: this one does the rest.
    }
    take(0);
    for (std::size_t p = threads.size() + 1; p < parts; ++p) take(p);
    for (std::thread& t : threads) t.join();
    for (const std::exception_ptr& each : thrown)
        if (each) std::rethrow_exception(each);
}

}  // namespace contactbench::bindings
