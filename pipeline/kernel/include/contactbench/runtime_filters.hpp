// The two filters of the runtime, sample by sample: of the wrench, and of the contact point.
//
// Contract
//   same as    contactbench.pipeline.filtering.KalmanFilter (each channel to the last bit) and LowPass (its starting state
//              is solved for in another order: 1e-12).
//   cost       no allocation after construction, nothing throws.
#pragma once

#include <vector>

#include "likelihood.hpp"

namespace contactbench {

struct KalmanSettings {
    double rate = 200.0;  // Hz, nominal
    double q = 1e-6, r = 2e-4, tuned_rate = 200.0;
    bool per_sample = false;
    bool adaptive = false;
    double sigma[6] = {};  // of a reading's noise, N and N*m; of an adaptive one
};

// x + gain (z - x), which settles to the last bit.
inline double blend(double x, double z, double gain) { return z * gain - (gain - 1) * x; }

// Each of six channels a random walk seen through white noise. All six share one variance, because a sample is
// either taken whole or lost whole.
//
// An adaptive one starts anew with a sample where the mean innovation is beyond chance; the mean weighs samples as the
// state does, so that it finds a slow change, too. A single sample, however far off, is not enough. Changes that turn
// back and back again within a moment are vibration, or more noise than declared: chance is then taken for larger.
class WrenchKalman {
public:
    explicit WrenchKalman(const KalmanSettings& s)
        : settings_(s), r_(s.per_sample ? s.r : s.r * (s.rate / s.tuned_rate)),
          first_q_(added(1.0 / s.rate)) {
        const double before = first_q_ / 2 + std::sqrt(first_q_) * std::sqrt(first_q_ / 4 + r_);
        settled_ = before / (before + 2 * r_);
    }

    void reset() noexcept { now_ = {}; }
    bool started() const noexcept { return now_.variance < HUGE_VAL; }
    const double* state() const noexcept { return now_.x; }
    double variance() const noexcept { return now_.variance; }
    // s: how much older than the sample is, on average, what the state is made of.
    double age() const noexcept { return now_.age; }

    // N: a force that chance does not take a reading away from; a fixed filter does not ask.
    double chance() const noexcept {
        const double* s = settings_.sigma;
        return settings_.adaptive ? 3 * std::max({s[0], s[1], s[2]}) : HUGE_VAL;
    }

    // Adds what the state is less certain of than a settled one: noise that is not yet averaged, and lag. False: nothing.
    bool add_doubt(WrenchCovariance& to) const noexcept {
        const double more = now_.left - settled_;
        if (!settings_.adaptive || !(now_.lags || more > 0.1 * settled_)) return false;
        for (int i = 0; i < 6; ++i) {
            to.s[i][i] += std::max(more, 0.0) * (settings_.sigma[i] * settings_.sigma[i]);
            for (int j = 0; j < 6; ++j) to.s[i][j] += now_.lag[i] * now_.lag[j];
        }
        return true;
    }

    // `dt`: seconds since the sample before, or 0 for a first one.
    void update(const double sample[6], double dt) noexcept {
        const double before = now_.variance + step(dt);
        double gain = 1 / (1 + r_ / before), share = 1.0;
        if (settings_.adaptive && started()) share = follow(sample, dt, std::sqrt(now_.scale * (1 + before / r_)), gain);
        for (int i = 0; i < 6; ++i) {
            const double z = share < 1 ? now_.x[i] + share * (sample[i] - now_.x[i]) : sample[i];
            now_.x[i] = blend(now_.x[i], z, gain);
        }
        now_.variance = gain * r_;
        now_.left = left_after(gain);
        now_.age = (1 - gain) * (now_.age + dt);
    }

    // A sample that came but says nothing: what is known only grows old.
    void skip(double dt) noexcept { now_.variance += step(dt), now_.age += dt; }

private:
    static constexpr double beyond = 24.0;        // times the variance that the mean innovation of six channels has
    static constexpr double lagging = 6.0;        // the same, from which on it is told as lag
    static constexpr double moment = 0.15;        // s
    static constexpr double forgotten = 10.0;     // s
    static constexpr double more_noise = 4.0, most_noise = 1e4;

    struct State {
        double x[6] = {};
        double variance = HUGE_VAL;
        double left = 1.0;      // of a reading's variance
        double age = 0.0;       // s
        double mean[6] = {};    // of the innovations since the last change, standard deviations
        double change[6] = {};  // the mean with which the last change was found
        double lag[6] = {};     // N and N*m
        double scale = 1.0;     // of the variance that is taken for chance
        double back = HUGE_VAL; // s since a change turned back
        bool lags = false;
    };

    double added(double dt) const noexcept {
        return settings_.per_sample ? settings_.q : settings_.q * (dt * settings_.tuned_rate);
    }
    double step(double dt) const noexcept { return dt > 0.0 ? added(dt) : first_q_; }
    double left_after(double gain) const noexcept { return gain * gain + (1 - gain) * (1 - gain) * now_.left; }

    // Returns the share of the innovation to believe: what is far off counts no more than what two of are a change.
    // `sigma`: of an innovation, over that of a reading. A change sets the gain to 1.
    double follow(const double sample[6], double dt, double sigma, double& gain) noexcept {
        double innovation[6], size2 = 0.0;
        for (int i = 0; i < 6; ++i) {
            innovation[i] = (sample[i] - now_.x[i]) / settings_.sigma[i] / sigma;
            size2 += innovation[i] * innovation[i];
        }
        const double left = left_after(gain), most = 1.2 / (2 - gain) * std::sqrt(beyond * left) / gain;
        const double share = size2 > most * most ? most / std::sqrt(size2) : 1.0;
        double mean2 = 0.0, turn = 0.0;
        for (int i = 0; i < 6; ++i) {
            now_.mean[i] += gain * (share * innovation[i] - now_.mean[i]);
            mean2 += now_.mean[i] * now_.mean[i];
            turn += now_.mean[i] * now_.change[i];
        }
        now_.scale = 1 + (now_.scale - 1) / (1 + dt / forgotten);
        now_.back += dt;
        const bool changed = mean2 > beyond * left;
        now_.lags = !changed && mean2 > lagging * left;
        // It grew from nothing, so that its mean is half of it.
        for (int i = 0; i < 6; ++i)
            now_.lag[i] = now_.lags ? 2 * (1 - gain) * sigma * settings_.sigma[i] * now_.mean[i] : 0.0;
        if (!changed) return share;
        if (turn < 0 && now_.back < moment) now_.scale = std::min(more_noise * now_.scale, most_noise);
        if (turn < 0) now_.back = 0.0;
        for (int i = 0; i < 6; ++i) now_.change[i] = now_.mean[i], now_.mean[i] = 0.0;
        gain = 1.0;
        return 1.0;
    }

    KalmanSettings settings_;
    double r_, first_q_;
    double settled_;  // share of a reading's variance that a settled state has
    State now_;
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
