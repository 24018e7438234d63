// Is a reading a measurement at all? What its value alone cannot tell.
//
// A hung sensor, or a box that lost its sensor, repeats the last reading for ever. So does a healthy but coarse one, now
// and then: how often is learned, and a run of repeats that chance would give once in 1 / `chance` runs is `frozen`.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace contactbench {

// Bits of a health word; 0: nothing is wrong. What is unhealthy is never accepted.
struct Health {
    static constexpr std::uint32_t frozen = 1;   // all six channels repeat beyond chance
    static constexpr std::uint32_t silent = 2;   // no sample comes
    static constexpr std::uint32_t flagged = 4;  // the sensor itself says that the reading is no good
    static constexpr std::uint32_t no_pose = 8;  // no orientation that is young enough
    static constexpr std::uint32_t clock = 16;   // the device's clock has just leapt: the sample's time is a guess
};

// What a sensor says of a reading; the same bits as contactbench.pipeline.devices.sample.Status.
struct Flag {
    static constexpr std::uint32_t overrange = 1, invalid = 2, raw = 4, late = 8, error = 16, clock_leapt = 32;

    // Those by which the sensor says that the numbers are no good.
    static constexpr std::uint32_t wrong(std::uint32_t flags) { return flags & ~(late | clock_leapt); }
};

class FrozenDetector {
public:
    // Takes the next reading; tells whether it is frozen. No reading (NaN) is no repeat.
    bool see(const double wrench[6], double chance) noexcept {
        if (std::equal(wrench, wrench + 6, last_)) {
            if (++run_ >= least) frozen_ = run_ >= needed(chance);
            return frozen_;
        }
        // A run that was told frozen and ended says little of how often a healthy sensor repeats itself.
        const double told = frozen_ ? std::min(double(run_), double(least)) : double(run_);
        repeats_ += told, seen_ += told + 1.0;
        if (!frozen_) keep(run_);
        if (seen_ > memory) {
            repeats_ *= 0.5, seen_ *= 0.5;
            for (std::int64_t& length : longest_) length -= length / 4;
        }
        std::copy(wrench, wrench + 6, last_);
        run_ = 0;
        return frozen_ = false;
    }

    void reset() noexcept { *this = FrozenDetector(); }

private:
    static constexpr std::int64_t least = 5;
    static constexpr int kept = 2;
    static constexpr double memory = 20000.0;

    void keep(std::int64_t run) noexcept {
        for (std::int64_t& length : longest_)
            if (run > length) std::swap(run, length);
    }

    // Repeats that come in clusters (a slow signal, coarsely counted) make longer runs than independent ones would. They
    // do so again and again: a single long run may as well have been a hang, and teaches nothing.
    std::int64_t needed(double chance) const noexcept {
        const double p = std::min((repeats_ + 9.0) / (seen_ + 10.0), 0.999);
        return std::max(std::int64_t(std::ceil(std::log(chance) / std::log(p))), 3 * longest_[kept - 1] + least);
    }

    double last_[6] = {};
    double repeats_ = 0.0, seen_ = 0.0;
    std::int64_t run_ = 0, longest_[kept] = {};  // the longest runs, descending
    bool frozen_ = false;
};

}  // namespace contactbench
