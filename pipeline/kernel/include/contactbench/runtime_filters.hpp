// The two filters of the runtime, sample by sample: of the wrench, and of the contact point.
//
// Contract
//   same as    contactbench.pipeline.filtering.KalmanFilter (each channel to the last bit) and LowPass (its starting state
//              is solved for in another order: 1e-12).
//   cost       no allocation after construction, nothing throws.
#pragma once

#include <vector>

#include "vec.hpp"

namespace contactbench {

struct KalmanSettings {
    double rate = 200.0;  // Hz, nominal
    double q = 1e-6, r = 2e-4, tuned_rate = 200.0;
    bool per_sample = false;
};

// Each of six channels a random walk seen through white noise. All six share one variance, because a sample is
// either taken whole or lost whole.
class WrenchKalman {
public:
    explicit WrenchKalman(const KalmanSettings& s)
        : settings_(s), r_(s.per_sample ? s.r : s.r * (s.rate / s.tuned_rate)),
          first_q_(added(1.0 / s.rate)) {
        reset();
    }

    void reset() noexcept {
        variance_ = HUGE_VAL;
        for (double& x : state_) x = 0.0;
    }

    bool started() const noexcept { return variance_ < HUGE_VAL; }
    const double* state() const noexcept { return state_; }

    // `dt`: seconds since the sample before, or 0 for a first one.
    void update(const double sample[6], double dt) noexcept {
        const double gain = 1 / (1 + r_ / (variance_ + step(dt)));
        for (int i = 0; i < 6; ++i) state_[i] = sample[i] * gain - (gain - 1) * state_[i];
        variance_ = gain * r_;
    }

    // A sample that came but says nothing: what is known only grows old.
    void skip(double dt) noexcept { variance_ += step(dt); }

private:
    double added(double dt) const noexcept {
        return settings_.per_sample ? settings_.q : settings_.q * (dt * settings_.tuned_rate);
    }
    double step(double dt) const noexcept { return dt > 0.0 ? added(dt) : first_q_; }

    KalmanSettings settings_;
    double r_, first_q_;
    double variance_ = HUGE_VAL;
    double state_[6] = {};
};

// One second-order section, b0 b1 b2 a0 a1 a2 with a0 = 1.
struct Section {
    double b[3] = {1, 0, 0}, a[3] = {1, 0, 0};
};

// A cascade of sections, direct form II transposed, that starts at its first sample as if it had always been
// there.
class PointLowPass {
public:
    explicit PointLowPass(std::vector<Section> sections) : memory_(sections.size()) {
        double scale = 1.0;
        for (std::size_t i = 0; i < sections.size(); ++i) {
            const Section& s = sections[i];
            // The state z of a constant input 1: z0 = z1 + b1 - a1 y, z1 = b2 - a2 y, y = b0 + z0.
            const double y = (s.b[0] + s.b[1] + s.b[2]) / (1 + s.a[1] + s.a[2]);
            memory_[i].section = s;
            memory_[i].first[1] = scale * (s.b[2] - s.a[2] * y);
            memory_[i].first[0] = scale * (y - s.b[0]);
            scale *= y;
        }
    }

    bool empty() const noexcept { return memory_.empty(); }
    void reset() noexcept { started_ = false; }

    Vec3 update(Vec3 p) noexcept {
        double x[3] = {p.x, p.y, p.z};
        if (!started_)
            for (Memory& m : memory_)
                for (int c = 0; c < 3; ++c)
                    for (int k = 0; k < 2; ++k) m.z[c][k] = m.first[k] * x[c];
        started_ = true;
        for (int c = 0; c < 3; ++c)
            for (Memory& m : memory_) {
                const Section& s = m.section;
                const double in = x[c];
                x[c] = s.b[0] * in + m.z[c][0];
                m.z[c][0] = s.b[1] * in - s.a[1] * x[c] + m.z[c][1];
                m.z[c][1] = s.b[2] * in - s.a[2] * x[c];
            }
        return {x[0], x[1], x[2]};
    }

private:
    struct Memory {
        Section section;
        double first[2] = {};  // of a constant input 1
        double z[3][2] = {};
    };
    std::vector<Memory> memory_;
    bool started_ = false;
};

}  // namespace contactbench
