// The smallest test harness that does the job: one macro, one counter, one source of random numbers.
//
// Own random numbers, because the distributions of the standard library differ between libraries: a
// failure must come back on every machine.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "contactbench/vec.hpp"

namespace testing {

struct Counts {
    long passed = 0, failed = 0;
    bool stop = false;  // at the first failure
};

inline Counts& counts() {
    static Counts c;
    return c;
}

// One bug fails thousands of checks: each line tells of its first failure only.
inline bool report(bool ok, bool& told, const char* what, const char* file, int line) {
    ++(ok ? counts().passed : counts().failed);
    if (!ok && !told) std::printf("%s:%d: failed: %s\n", file, line, what);
    told |= !ok;
    if (!ok && counts().stop) std::exit(1);
    return ok;
}

#define CHECK(condition)                                                                 \
    [&](bool ok) {                                                                       \
        static bool told = false;                                                        \
        return ::testing::report(ok, told, #condition, __FILE__, __LINE__);              \
    }(bool(condition))

// |a - b| within `tolerance` of the larger, or of `scale` when that is larger still.
inline bool close(double a, double b, double tolerance, double scale = 0.0) {
    return std::fabs(a - b) <= tolerance * std::fmax(scale, std::fmax(std::fabs(a), std::fabs(b)));
}

// splitmix64.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return z ^ (z >> 31);
    }
    std::size_t below(std::size_t n) { return std::size_t(bits() % n); }
    double unit() { return double(bits() >> 11) * 0x1p-53; }
    double uniform(double lo, double hi) { return lo + (hi - lo) * unit(); }
    double normal() {
        return std::sqrt(-2.0 * std::log(1.0 - unit())) * std::cos(6.283185307179586 * unit());
    }
    contactbench::Vec3 normal3() {
        const double x = normal(), y = normal();
        return {x, y, normal()};
    }
    contactbench::Vec3 direction() {
        const contactbench::Vec3 v = normal3();
        return (1.0 / contactbench::norm(v)) * v;
    }

private:
    std::uint64_t state_;
};

}  // namespace testing
